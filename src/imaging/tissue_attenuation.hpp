// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "echo_field.hpp"

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/imaging_settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

/// The share of the amplitude that comes back from each sample: weakened by the tissue on its way, strengthened by the
/// receiver's gain with depth. Does not allocate after construction.
class TissueAttenuation {
 public:
  TissueAttenuation(int lines, int samples);

  /// Weakens the echoes of a picture.
  /// @param echoes (regions of the mesh)
  /// @param tets (lines × samples) tetrahedron of each sample, or -1: nothing is there
  /// @param is_concretion (lines × samples)
  void apply(const UltrasoundBeams& beams, double frequency_MHz, const TetMesh& mesh,
             std::span<const TissueEcho> echoes, std::span<const Index> tets,
             std::span<const std::uint8_t> is_concretion, EchoField& field);

  /// (lines × samples) the share of each sample in the last picture.
  [[nodiscard]] std::span<const float> gain() const { return gain_; }

 private:
  void blur_shadows(const UltrasoundBeams& beams, double depth_mm);

  std::vector<float> passed_, blurred_;  ///< (lines) share that comes back from a depth
  std::vector<float> gain_;
};

}  // namespace stylet
