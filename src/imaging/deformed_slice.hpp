// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/imaging/ultrasound_beams.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace stylet {

/// The part of a line of an ultrasound picture inside one deformed tetrahedron. At the distance r from the probe's
/// surface the weights of its corners are weights + r · slopes, and the undeformed place is undeformed_mm + r · course.
struct BeamSpan {
  int line = 0;
  Index tet = -1;
  double from_mm = 0.0, to_mm = 0.0;  ///< distances from the probe's surface, from < to
  Vec4 weights, slopes;
  Vec3 undeformed_mm, course;
  Index behind = -1;    ///< tetrahedron on the other side of the face through which the line leaves, or -1
  bool leaves = false;  ///< whether the line leaves at to_mm through a face, before the picture ends
  double cosine = 0.0;  ///< between the line and the deformed normal of that face
};

/// Cuts the deformed mesh by the plane of an ultrasound picture, line by line. Does not allocate after construction.
class DeformedSlice {
 public:
  DeformedSlice(const TetMesh& mesh, int lines)
      : mesh_(&mesh),
        topology_(mesh),
        places_(3, mesh.node_count()),
        above_(static_cast<std::size_t>(mesh.node_count())),
        starts_(static_cast<std::size_t>(lines)),
        ways_(static_cast<std::size_t>(lines)) {}

  [[nodiscard]] const TetMesh& mesh() const { return *mesh_; }

  /// Moves the nodes and takes over the lines of a picture.
  /// @param displacement (3 × nodes) [mm] LPS
  void place(const UltrasoundBeams& beams, const Eigen::Matrix3Xf& displacement);

  /// Calls take(const BeamSpan&) for each tetrahedron on each line, tetrahedron by tetrahedron.
  /// @param beams those of place()
  /// @param wanted (Index tet) → bool: whether a tetrahedron is looked at
  template <class Take, class Wanted>
  void cut(const UltrasoundBeams& beams, Take&& take, Wanted&& wanted) const {
    for (std::size_t t = 0; t < mesh_->tets.size(); ++t) {
      const auto& corners = mesh_->tets[t];
      int above = 0;
      for (const Index node : corners) above += above_[static_cast<std::size_t>(node)];
      if (above == 0 || above == 4 || !wanted(static_cast<Index>(t))) continue;
      one(beams, static_cast<Index>(t), take);
    }
  }

  /// Weights of the corners of a tetrahedron at a place in the plane of the last place() (across, ahead) [mm].
  [[nodiscard]] Vec4 weights(Index tet, const Eigen::Vector2d& in_plane) const;
  /// Derivative of the undeformed place by the deformed one in a tetrahedron of the last place() (3 × 3, LPS).
  /// @param beams those of place()
  [[nodiscard]] Mat3 undeformed_by_deformed(const UltrasoundBeams& beams, Index tet) const;

 private:
  struct Lines {
    int first = 0, last = -1;
  };

  [[nodiscard]] Lines lines_of(const UltrasoundBeams& beams, const std::array<Index, 4>& corners) const;

  template <class Take>
  void one(const UltrasoundBeams& beams, Index tet, Take& take) const {
    const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
    const Lines lines = lines_of(beams, corners);
    if (lines.first > lines.last) return;
    const Vec3 p0 = places_.col(corners[0]);
    Mat3 edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = places_.col(corners[static_cast<std::size_t>(k) + 1]) - p0;
    const Mat3 inverse = edges.inverse();
    if (!inverse.allFinite()) return;
    Eigen::Matrix<double, 4, 3> gradients;  // of the weights
    gradients.bottomRows<3>() = inverse;
    gradients.row(0) = -inverse.colwise().sum();
    Vec4 at_origin = -(gradients * p0);  // weights at the origin of the plane
    at_origin[0] += 1.0;
    Eigen::Matrix<double, 3, 4> undeformed;
    for (int k = 0; k < 4; ++k)
      undeformed.col(k) = mesh_->nodes[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
    const Vec3 undeformed_origin = undeformed * at_origin;
    const Eigen::Matrix<double, 3, 2> courses = undeformed * gradients.leftCols<2>();
    BeamSpan span;
    span.tet = tet;
    const double depth = beams.sample_mm * (beams.samples - 1);
    for (int line = lines.first; line <= lines.last; ++line) {
      const Eigen::Vector2d& start = starts_[static_cast<std::size_t>(line)];
      const Eigen::Vector2d& way = ways_[static_cast<std::size_t>(line)];
      span.weights = at_origin + gradients.leftCols<2>() * start;
      span.slopes = gradients.leftCols<2>() * way;
      double from = 0.0, to = depth;
      int face = -1;
      for (int k = 0; k < 4; ++k) {
        const double w = span.weights[k], slope = span.slopes[k];
        if (slope > 0.0) {
          from = std::max(from, -w / slope);
        } else if (slope < 0.0) {
          if (-w / slope < to) {
            to = -w / slope;
            face = k;
          }
        } else if (w < 0.0) {
          to = -1.0;
        }
      }
      if (!(from < to)) continue;
      span.undeformed_mm = undeformed_origin + courses * start;
      span.course = courses * way;
      span.line = line;
      span.from_mm = from;
      span.to_mm = to;
      span.leaves = face >= 0;
      span.behind = face >= 0 ? topology_.neighbour[static_cast<std::size_t>(tet)][static_cast<std::size_t>(face)] : -1;
      span.cosine = face >= 0 ? -span.slopes[face] / gradients.row(face).norm() : 0.0;
      take(static_cast<const BeamSpan&>(span));
    }
  }

  const TetMesh* mesh_;
  Topology topology_;
  Eigen::Matrix3Xd places_;
  std::vector<std::uint8_t> above_;  ///< (nodes) 1 in front of the plane; small, since it is read for every tetrahedron
  std::vector<Eigen::Vector2d> starts_, ways_;  ///< (lines)
};

}  // namespace stylet
