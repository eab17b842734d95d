// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of each source model, as its publication gives them; lengths in mm.
#pragma once

#include "stylet/dose/source_model.hpp"

#include <cstddef>
#include <initializer_list>
#include <limits>

namespace stylet::dose::sources {

/// Stands where a publication has no value.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A matrix with this number of rows, from its values row by row.
inline MatX table(std::size_t rows, std::initializer_list<double> values) {
  const auto n = static_cast<Eigen::Index>(rows);
  const auto m = static_cast<Eigen::Index>(values.size()) / n;
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(values.begin(), n, m);
}

SourceModel i125_6711();
SourceModel i125_selectseed();
SourceModel i125_agx100();
SourceModel i125_best2301();
SourceModel pd103_theraseed200();
SourceModel cs131_cs1rev2();
SourceModel ir192_gammamed_plus();
SourceModel ir192_flexisource();
SourceModel ir192_mhdr_v1();
SourceModel ir192_mhdr_v2();

}  // namespace stylet::dose::sources
