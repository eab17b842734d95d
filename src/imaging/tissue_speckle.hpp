// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "deformed_slice.hpp"
#include "echo_field.hpp"
#include "echo_map.hpp"
#include "material_shift.hpp"
#include "point_spread.hpp"
#include "speckle_lattice.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stylet {

/// The tissue at each sample of a picture. All arrays are (lines × samples).
struct SampledTissue {
  explicit SampledTissue(std::size_t samples) : tets(samples), is_concretion(samples) {}
  void clear();

  std::vector<Index> tets;                  ///< tetrahedron, or -1
  std::vector<std::uint8_t> is_concretion;  ///< 1: a calcification
};

/// The beams of a picture and the tissue that they pass, from which its speckle is made.
struct SpeckleScene {
  const UltrasoundBeams& beams;
  const BeamProfile& profile;
  const MaterialShift& shift;
  const PointSpread& spread;
};

/// Fills a picture with the speckle of its tissue: noise that is fixed in the material, as strong as the region or the
/// painted map says. Does not allocate after construction.
class TissueSpeckle {
 public:
  /// @param echoes (regions) @param map null: none @param samples of a line
  TissueSpeckle(std::span<const TissueEcho> echoes, std::shared_ptr<const EchoMap> map, std::uint32_t seed,
                int samples);

  /// Takes over the thickness of the slice.
  void begin(const UltrasoundBeams& beams, const BeamProfile& profile);
  /// Fills the samples of a span. @param region of its tetrahedron
  void fill(const SpeckleScene& scene, const BeamSpan& span, std::size_t region, SampledTissue& tissue,
            EchoField& field) const;

  [[nodiscard]] const SpeckleLattice& lattice() const { return lattice_; }
  [[nodiscard]] const std::shared_ptr<const EchoMap>& map() const { return map_; }

 private:
  void fill_row(const SpeckleScene& scene, int line, int from, int to, float amplitude, const Vec3& x0, const Vec3& dx,
                SampledTissue& tissue, EchoField& field) const;

  SpeckleLattice lattice_;
  std::vector<float> amplitudes_;       ///< (regions)
  std::shared_ptr<const EchoMap> map_;  ///< null: none
  std::array<float, 256> of_level_{};   ///< amplitude of each level of the map
  std::vector<float> slice_mm_;         ///< (samples) distance from the plane at which tissue is looked at
};

/// The amplitude of a level.
float amplitude_of_dB(double dB);

}  // namespace stylet
