// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <optional>
#include <string>
#include <vector>

/// What the readers of DICOM share: values of attributes as they are used here. To be called in a child process only.
namespace stylet::detail {

/// All values of an attribute as one text, trimmed; empty when it is absent.
std::string text_of(DcmItem& item, const DcmTagKey& tag);

/// A whole number, nothing when the attribute is absent or something else.
std::optional<int> integer_of(DcmItem& item, const DcmTagKey& tag);

/// The numbers of an attribute with several values; empty when it is absent or one of them is no finite number.
std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag);

/// The items of a sequence, none when it is absent.
std::vector<DcmItem*> items_of(DcmItem& parent, const DcmTagKey& tag);

}  // namespace stylet::detail
