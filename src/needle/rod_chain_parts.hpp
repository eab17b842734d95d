// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"
#include "needle/beam_tangent.hpp"
#include "needle/bow.hpp"
#include "stylet/needle/rod_chain.hpp"

namespace stylet {

struct RodChain::Parts {
  Parts(const NeedleSection& section, int elements, int load_capacity, beam::ElementKind kind)
      : length(section.length_mm),
        shape(elements, section.length_mm, section.bending_stiffness_Nmm2, section.torsion_stiffness_Nmm2, kind),
        tangent(shape, load_capacity),
        prepared(shape, load_capacity) {
    bend_rest(section);
  }

  /// Bows the unloaded shape: it gets the same curvature everywhere, except that the joint at the clamp, which stands
  /// for half a rod, gets half.
  void bend_rest(const NeedleSection& section) {
    const Vec3 axis = bow_axis(section);
    const auto bend = [&](double k) {
      for (int e = 0; e < shape.elements(); ++e)
        shape.rest.segment<3>(beam::dof(e)) = k / shape.elastic_weight(e) * axis;
      shape.curvature = shape.rest;
      shape.update();
    };
    bend(bow_curvature(section, [&](double k) {
      bend(k);
      return shape.point(length).head<2>().norm();
    }));
  }

  double length;
  Pose base;
  Mat3 base_rotation = Mat3::Identity();
  beam::BeamShape shape;
  beam::BeamTangent tangent;
  beam::BeamTangent prepared;  ///< a new tangent, prepared while the other one is in use
  /// The next piece of work on that tangent: L⁻¹Jᵀ, then the compliance in two parts.
  enum class Preparing { nothing, solution, first_loads, last_loads, complete } preparing = Preparing::nothing;
};

}  // namespace stylet
