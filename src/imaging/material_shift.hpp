// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "deformed_slice.hpp"
#include "stylet/imaging/needle_field.hpp"

namespace stylet {

/// How much further the material moved beside the needle than the mesh shows: for places of a picture, the undeformed
/// place minus the one that the mesh gives. Kept on a grid of some lines and samples, linear in between.
class MaterialShift {
 public:
  MaterialShift(const TetMesh& mesh, int lines, int samples);

  static constexpr int kSampleStep = 5;  ///< samples from one point of the grid to the next

  /// @param slice has the nodes' places and the lines
  void compute(const UltrasoundBeams& beams, const Moment& moment, const DeformedSlice& slice);

  /// Whether the shift may differ from zero between two samples of a line.
  [[nodiscard]] bool touches(int line, int from, int to) const;
  /// The shift [mm] LPS at a sample of a line.
  [[nodiscard]] Eigen::Vector3f at(int line, int sample) const;

 private:
  struct Range {
    int first = 1, last = 0;  ///< columns that differ from zero; first > last: none
  };
  [[nodiscard]] Vec3 solve(const UltrasoundBeams& beams, const DeformedSlice& slice, Index tet, const Vec4& weights,
                           const Vec3& x);

  const TetMesh* mesh_;
  NeedleField field_;
  int line_step_ = 2;
  int columns_;  ///< grid points along a line
  Eigen::Matrix3Xf grid_;
  std::vector<Range> touched_;  ///< (grid lines)
};

}  // namespace stylet
