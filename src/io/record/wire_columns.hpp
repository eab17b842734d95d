// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detail/wire.hpp"
#include "stylet/core/field.hpp"

namespace stylet::detail {

/// The fields of a record that a file has, for the way from the reading program to the one that asked.
template <record::HasColumns T>
void fields(auto& wire, T& record) {
  record::each_field<record::kFile>(record, [&](const record::Field&, auto& value) { wire(value); });
}

}  // namespace stylet::detail
