// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"
#include "needle/beam_tangent.hpp"
#include "stylet/needle/rod_chain.hpp"

namespace stylet {

struct RodChain::Parts {
  Parts(const NeedleSection& section, int elements, int load_capacity, beam::ElementKind kind)
      : length(section.length_mm),
        shape(elements, section.length_mm, section.bending_stiffness_Nmm2, section.torsion_stiffness_Nmm2, kind),
        tangent(shape, load_capacity) {}

  double length;
  Pose base;
  Mat3 base_rotation = Mat3::Identity();
  beam::BeamShape shape;
  beam::BeamTangent tangent;
};

}  // namespace stylet
