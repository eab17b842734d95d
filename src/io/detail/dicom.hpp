// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <optional>
#include <string>
#include <vector>

/// Access to DICOM attributes, shared by the DICOM readers. To be called in a child process only.
namespace stylet::detail {

/// All values of an attribute as one text, trimmed; empty if it is absent.
std::string text_of(DcmItem& item, const DcmTagKey& tag);

/// The value of an attribute as a whole number; empty if it is absent or not a whole number.
std::optional<int> integer_of(DcmItem& item, const DcmTagKey& tag);

/// The numbers of an attribute with several values; empty if it is absent or one of them is not a finite number.
std::vector<double> numbers_of(DcmItem& item, const DcmTagKey& tag);

/// The items of a sequence; none if it is absent.
std::vector<DcmItem*> items_of(DcmItem& parent, const DcmTagKey& tag);

}  // namespace stylet::detail
