// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/near_place.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

/// Beyond this many edges the mesh represents the field well enough: what remains is the error of interpolation, of the
/// relative size (edge / distance)² / 4.
constexpr double kMostEdges = 5.0;

/// Sets the size of the elements, the free surface and the share that is not held, interpolated from the nodes.
template <class NodeAt>
void describe_surroundings(const Tissue& tissue, const MeshKernel& kernel, int count, const NodeAt& node_at,
                           NearPlace& place) {
  const bool has_skin = std::isfinite(kernel.skin(node_at(0).first).depth);
  place.skin = {0.0, Vec3::Zero(), 0.0};
  place.moves = 0.0;
  for (int i = 0; i < count; ++i) {
    const auto [node, weight] = node_at(i);
    place.edge += weight * kernel.edge(node);
    if (!tissue.is_fixed(node)) place.moves += weight;
    if (!has_skin) continue;
    const NearSurface& there = kernel.skin(node);
    place.skin.depth += weight * there.depth;
    place.skin.inwards += weight * there.inwards;
    place.skin.share += weight * there.share;
  }
  place.moves = std::clamp(place.moves, 0.0, 1.0);
  place.skin.inwards.normalize();
  place.skin.depth = std::max(0.0, place.skin.depth);
  if (!has_skin) place.skin = {};
}

/// [mm] Distance that stands for a missing border at a corner, where other corners have a border.
constexpr double kNoBorder_mm = 100.0;

/// Whether two corners of an element that reaches through a thin layer lie on the two faces of that layer: each corner
/// is much nearer to its own face than to the facing one. The nearest face of one is then the facing one of the other.
bool on_two_faces(const NearInterfaces& a, const NearInterfaces& b) {
  constexpr double much = 4.0;
  return a[0].inwards.dot(b[0].inwards) < -0.5 && much * (a[0].depth + b[0].depth) < std::min(a[1].depth, b[1].depth) &&
         a[1].beyond >= 0 && b[1].beyond >= 0;
}

/// The interfaces near a place of a region, interpolated from the corners of its element.
NearBorders borders_at(const MeshKernel& kernel, int region, double young_MPa, const std::array<Index, 4>& corners,
                       const Vec4& weights) {
  std::array<const NearInterfaces*, 4> of{};
  for (std::size_t i = 0; i < 4; ++i) of[i] = &kernel.interfaces_of(corners[i], region);
  const NearInterfaces& first = **std::min_element(
      of.begin(), of.end(), [](const auto* a, const auto* b) { return (*a)[0].depth < (*b)[0].depth; });
  NearBorders borders;
  for (std::size_t side = 0; side < 2; ++side) {
    NearBorder border{0.0, Vec3::Zero()};
    double log_beyond = 0.0;
    double known = 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) {
      const NearInterface& there = (*of[i])[on_two_faces(*of[i], first) ? 1 - side : side];
      const double weight = weights[static_cast<Eigen::Index>(i)];
      const bool is_any = there.beyond >= 0;
      border.depth += weight * (is_any ? std::min(there.depth, kNoBorder_mm) : kNoBorder_mm);
      if (!is_any) continue;
      border.inwards += weight * there.inwards;
      log_beyond += weight * there.log_beyond;
      known += weight;
      if (there.depth < nearest) {
        nearest = there.depth;
        border.beyond = there.beyond;
      }
    }
    if (border.beyond < 0 || known <= 0.0 || border.inwards.isZero(0.0)) continue;
    border.depth = std::max(0.0, border.depth);
    border.inwards.normalize();
    const double beyond_MPa = std::exp(log_beyond / known);
    border.contrast = (young_MPa - beyond_MPa) / (young_MPa + beyond_MPa);
    borders[side] = border;
  }
  return borders;
}

/// [mm] Radius over which the mesh spreads a force. @param g of the mesh between the place of the force and itself, for
/// E = 1 MPa
double mesh_blur(const Medium& medium, const Mat3& g) { return 3.0 * kelvinlet_self(medium) / g.trace(); }

/// The largest s for which `whole` − s `part` has no negative eigenvalue. @param whole symmetric
double largest_share(const Mat3& whole, const Mat3& part) {
  const Eigen::LLT<Mat3> root(whole);
  if (root.info() != Eigen::Success) return 0.0;
  const Mat3 half = root.matrixL().solve(part);
  const Mat3 relative = root.matrixL().solve(half.transpose());
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(0.5 * (relative + relative.transpose()), Eigen::EigenvaluesOnly);
  const double largest = eigen.eigenvalues().maxCoeff();
  return largest > 0.0 ? 1.0 / largest : std::numeric_limits<double>::infinity();
}

bool touch(const MeshKernel& kernel, const Shape& at, const Shape& on) {
  for (int i = 0; i < at.count; ++i) {
    for (int j = 0; j < on.count; ++j) {
      if (kernel.neighbours(at.node[static_cast<std::size_t>(i)], on.node[static_cast<std::size_t>(j)])) return true;
    }
  }
  return false;
}

}  // namespace

NearPlace near_place(const Tissue& tissue, const MeshKernel& kernel, const MaterialPoint& at, const Vec3& x) {
  const int region = tissue.mesh().tet_region[static_cast<std::size_t>(at.tet)];
  NearPlace place;
  place.shape = tissue.shape(at.tet, at.weights);
  place.piece.centre = x;
  place.medium = kernel.medium_of(region);
  place.young_MPa = tissue.material(region).young_MPa;
  const auto& corners = tissue.mesh().tets[static_cast<std::size_t>(at.tet)];
  describe_surroundings(
      tissue, kernel, 4,
      [&](int i) {
        return std::pair{corners[static_cast<std::size_t>(i)], static_cast<double>(at.weights[i])};
      },
      place);
  place.region = region;
  place.borders = borders_at(kernel, region, place.young_MPa, corners, at.weights);
  place.mesh_kernel = mesh_kernel_between(kernel, place.shape, place.shape, place.medium);
  place.blur = mesh_blur(kernel.medium(place.medium), place.mesh_kernel);
  return place;
}

void take_tip_radii(const NeedleKernel& needle, const MeshKernel& kernel, NearPlace& tip) {
  const double poisson = kernel.medium(tip.medium).poisson;
  tip.epsilon = std::max(needle.tip_epsilon(tip.skin, poisson), needle.own_tip_epsilon({}, tip.borders, poisson));
  tip.own_epsilon = needle.own_tip_epsilon(tip.skin, tip.borders, poisson);
  tip.share = least_share(tip.borders, tip.epsilon, poisson);
  tip.wide_share = least_share(tip.borders, NeedleKernel::kScale_mm, poisson);
}

NearPlace passive_place(const Tissue& tissue, const MeshKernel& kernel, const Shape& between, const Vec3& x) {
  NearPlace place;
  place.shape = between;
  place.piece.centre = x;
  describe_surroundings(
      tissue, kernel, between.count,
      [&](int i) {
        return std::pair{between.node[static_cast<std::size_t>(i)], between.weight[static_cast<std::size_t>(i)]};
      },
      place);
  return place;
}

NearPlace acted_on_by(NearPlace here, const NearPlace& on) {
  here.epsilon = on.epsilon;
  here.medium = on.medium;
  here.young_MPa = on.young_MPa;
  return here;
}

namespace {

bool across_a_gap(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on) {
  const double edge = 0.5 * (at.edge + on.edge);
  return (at.piece.centre - on.piece.centre).squaredNorm() < edge * edge && !touch(kernel, at.shape, on.shape);
}

}  // namespace

bool needs_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on) {
  const double far = kMostEdges * 0.5 * (at.edge + on.edge);
  if ((at.piece.centre - on.piece.centre).squaredNorm() > far * far) return false;
  return at.moves * on.moves != 0.0 && !across_a_gap(kernel, at, on);
}

Mat3 mesh_kernel_between(const MeshKernel& kernel, const Shape& at, const Shape& on, int medium) {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < at.count; ++i) {
    for (int j = 0; j < on.count; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      const double weight = at.weight[a] * on.weight[b];
      if (weight != 0.0) sum += weight * kernel(at.node[a], on.node[b], medium);
    }
  }
  return sum;
}

Mat3 tip_correction(const MeshKernel& kernel, const NearPlace& tip, const Mat3& g) {
  const Medium medium = kernel.medium(tip.medium);
  return between_media(tip, tip, [&](int /*medium*/) -> Mat3 {
    // The mesh represents the interface too, but only with the radius over which its elements spread a force.
    return tip_kernel(tip.skin, tip.borders, tip.own_epsilon, medium) -
           with_borders(g, tip.skin, tip.borders, std::max(tip.blur, tip.own_epsilon), medium.poisson);
  });
}

Mat3 tip_wide_correction(const MeshKernel& kernel, const NearPlace& tip, const Mat3& g) {
  return between_media(tip, tip, [&](int medium) -> Mat3 {
    return tip_kernel(tip.skin, {}, NeedleKernel::kScale_mm, kernel.medium(medium)) - g;
  });
}

Mat3 narrow_part(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on) {
  if (across_a_gap(kernel, at, on)) return Mat3::Zero();
  const bool together = at.region == on.region;
  const double share = together ? std::sqrt(at.share * on.share) : 1.0;
  const double wide_share = together ? std::sqrt(at.wide_share * on.wide_share) : 1.0;
  const double epsilon = std::sqrt(at.epsilon * on.epsilon);
  return between_media(at, on, [&](int number) -> Mat3 {
    const Medium medium = kernel.medium(number);
    return share * needle_kernel(at.piece, at.skin, on.piece, on.skin, epsilon, medium) -
           wide_share *
               point_kernel(at.piece.centre - on.piece.centre, at.skin, on.skin, NeedleKernel::kScale_mm, medium);
  });
}

Mat3 tip_narrow_part(const MeshKernel& kernel, const NearPlace& tip) {
  return between_media(tip, tip, [&](int number) -> Mat3 {
    const Medium medium = kernel.medium(number);
    return tip_kernel(tip.skin, tip.borders, tip.own_epsilon, medium) -
           tip_kernel(tip.skin, tip.borders, NeedleKernel::kScale_mm, medium);
  });
}

double softness_in_mesh(const MeshKernel& kernel, const NearPlace& place, const Mat3& far, const Mat3& g) {
  // Least share that the wide part of a place's own compliance keeps, of the compliance of a force spread over 10 mm in
  // a medium of the same softness.
  constexpr double least = 0.3;
  const Mat3 taken = between_media(place, place, [&](int own) -> Mat3 {
    return g - (1.0 - least) *
                   point_kernel(Vec3::Zero(), place.skin, place.skin, NeedleKernel::kScale_mm, kernel.medium(own));
  });
  return std::min(least_share_below(place.skin, place.borders, place.blur, kernel.medium(place.medium).poisson),
                  largest_share(far, taken));
}

}  // namespace stylet
