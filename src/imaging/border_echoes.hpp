// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "deformed_slice.hpp"
#include "echo_field.hpp"
#include "interface_echo.hpp"
#include "point_spread.hpp"
#include "speckle_lattice.hpp"

#include <span>
#include <vector>

namespace stylet {

/// Echoes of the borders between tissues. Does not allocate after construction.
class BorderEchoes {
 public:
  /// @param lines of a picture
  BorderEchoes(const TetMesh& mesh, int lines);

  void clear() { hits_.clear(); }
  /// Notes the border where a line leaves a tetrahedron, if it is one.
  void note(const BeamSpan& span);
  /// Adds the echoes of all noted borders. @param gain (lines × samples) share of the amplitude that comes back
  void add(const UltrasoundBeams& beams, std::span<const float> gain, const SpeckleLattice& lattice,
           const PointSpread& spread, EchoField& field) const;

 private:
  /// A place where a line crosses a border between tissues.
  struct Hit {
    int line;
    float depth_mm;
    float amplitude;
    double roughness_mm;
    Vec3 at;  ///< undeformed
  };

  const TetMesh& mesh_;
  std::vector<TissueRole> roles_;  ///< (regions)
  std::vector<Hit> hits_;
};

}  // namespace stylet
