// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace stylet::detail {

/// A text of a DICOM file in UTF-8, without control characters. Bytes that the character sets do not explain become
/// U+FFFD; bytes beyond ASCII in a file that states no character set count as UTF-8 if they are.
/// @param character_sets SpecificCharacterSet (0008,0005), values separated by backslashes: single sets ("ISO_IR 100",
///   "GB18030"), or code extensions by escape sequences of ISO 2022 ("\ISO 2022 IR 87")
/// Source: DICOM PS3.3 C.12.1.1.2, PS3.5 6.1.2.
std::string dicom_utf8(std::string_view text, std::string_view character_sets);

}  // namespace stylet::detail
