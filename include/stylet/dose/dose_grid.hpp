// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace stylet {

/// Dose on a regular grid of points. The point (i, j, k) is at origin_mm + direction · (spacing_mm ∘ (i, j, k)).
struct DoseGrid {
  std::string file;                    ///< file from which the grid was read; may be empty
  std::string frame_of_reference;      ///< UID of the DICOM frame of reference; may be empty
  std::string plan_uid;                ///< UID of the plan whose dose it is (300C,0002); may be empty
  std::string type;                    ///< dose type (3004,0004), such as "PHYSICAL"; may be empty
  std::string summation;               ///< the subject of the dose (3004,000A), such as "PLAN"; may be empty
  std::array<Index, 3> size{0, 0, 0};  ///< number of points along i, j, k
  Vec3 origin_mm = Vec3::Zero();       ///< [mm] LPS, point (0, 0, 0)
  Vec3 spacing_mm = Vec3::Ones();      ///< [mm] distance of neighbours along i, j, k, > 0
  Mat3 direction = Mat3::Identity();   ///< columns: unit directions of i, j, k in LPS, perpendicular to each other
  std::vector<float> dose_Gy;          ///< (size[0]·size[1]·size[2]) i varies fastest
  double quantum_Gy = 0.0;             ///< step [Gy] by which stored doses differ (DoseGridScaling); 0: none
  double largest_Gy = 0.0;             ///< largest dose [Gy] that the stored numbers can express; 0: no limit
  std::vector<std::string> notes;      ///< sentences for the user: what the reader decided or left out

  [[nodiscard]] std::size_t count() const;
  /// Place of a grid point [mm].
  [[nodiscard]] Vec3 point(Index i, Index j, Index k) const;
  /// Whether a place [mm] lies between grid points, so that at() interpolates.
  [[nodiscard]] bool covers(const Vec3& x) const;
  /// Dose [Gy] at a place [mm], linearly between grid points; outside the grid that of the nearest place of the grid.
  [[nodiscard]] double at(const Vec3& x) const;
};

}  // namespace stylet
