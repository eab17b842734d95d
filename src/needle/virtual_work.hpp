// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"
#include "stylet/needle/needle.hpp"

#include <span>
#include <vector>

namespace stylet::beam {

/// Virtual work of point loads per curvature of each element, Σ_c (∂r_c/∂κ_e)ᵀ f_c. The last result is kept, because an
/// iteration asks for the same shape and loads twice. Nothing allocates after reserve().
class VirtualWork {
 public:
  explicit VirtualWork(int elements);

  /// Allocates memory for this number of loads.
  void reserve(Eigen::Index loads);

  /// Computes the virtual work, or returns the kept result.
  /// @param base_rotation base axes to LPS
  /// @return [N mm²] (one per element) in the elements' axes, valid until the next call
  [[nodiscard]] std::span<const Vec3> of(const BeamShape& shape, const Mat3& base_rotation,
                                         std::span<const PointLoad> loads);

 private:
  [[nodiscard]] bool is_known(const BeamShape& shape, const Mat3& base_rotation,
                              std::span<const PointLoad> loads) const;
  void sort_pulls(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads);

  std::vector<Vec3> work_;  ///< (elements) the kept result
  // Arguments for which the result is kept.
  unsigned revision_ = 0;         ///< revision of the shape
  Mat3 rotation_ = Mat3::Zero();  ///< base rotation; zero, which is no rotation, before the first call
  std::vector<PointLoad> loads_;
  // The pulls of the loads, as one linked list per element.
  std::vector<Pull> pulls_;  ///< in base axes, without those before the base
  std::vector<int> first_;   ///< (elements) position in pulls_ of the first pull on the element; -1: none
  std::vector<int> next_;    ///< (pulls) position of the next pull on the same element; -1: none
};

}  // namespace stylet::beam
