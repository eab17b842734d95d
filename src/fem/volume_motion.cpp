// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/volume_motion.hpp"

#include "discretisation.hpp"
#include "quadratic_solve.hpp"
#include "stylet/geom/tet_part.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

constexpr int kRotation = 9;   ///< first column of the rotation in Fields
constexpr int kDilation = 12;  ///< column of the dilation in Fields

/// Five quadrature points of a tetrahedron, exact for cubic functions. @cite Keast1986
struct Quadrature {
  std::array<Vec4, 5> points;
  std::array<double, 5> weights{-0.8, 0.45, 0.45, 0.45, 0.45};

  Quadrature() {
    points[0].setConstant(0.25);
    for (std::size_t k = 0; k < 4; ++k) {
      points[k + 1].setConstant(1.0 / 6.0);
      points[k + 1][static_cast<Eigen::Index>(k)] = 0.5;
    }
  }
};

using Corners = Eigen::Matrix<double, 3, 4>;
Corners corners_of(const TetMesh& mesh, Index t) {
  Corners x;
  for (int i = 0; i < 4; ++i)
    x.col(i) =
        mesh.nodes[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)])];
  return x;
}

/// The matrix [r]× with [r]× u = r × u.
Mat3 cross_matrix(const Vec3& r) {
  Mat3 m;
  m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return m;
}

/// Volume, centroid, second moments about the centroid, and extent of some elements of a mesh.
struct Body {
  std::vector<Index> tets;
  double volume = 0.0;
  Vec3 centroid = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();  ///< ∫ (|r|² − r rᵀ) dV about the centroid [mm⁵]
  double low = std::numeric_limits<double>::infinity(), high = -low;  ///< extent along z [mm]

  Body(const TetMesh& mesh, std::span<const int> regions) {
    for (Index t = 0; t < mesh.tet_count(); ++t) {
      const int region = mesh.tet_region[static_cast<std::size_t>(t)];
      if (std::find(regions.begin(), regions.end(), region) == regions.end()) continue;
      tets.push_back(t);
      const Corners x = corners_of(mesh, t);
      const double v = tet_volume(mesh, t);
      volume += v;
      centroid += v * x.rowwise().mean();
      low = std::min(low, x.row(2).minCoeff());
      high = std::max(high, x.row(2).maxCoeff());
    }
    if (tets.empty()) return;
    centroid /= volume;
    for (const Index t : tets) {
      // ∫ r rᵀ = V/20 (Σ rᵢ rᵢᵀ + Σ rᵢ Σ rᵢᵀ), because r is linear in an element.
      const Corners r = corners_of(mesh, t).colwise() - centroid;
      const Vec3 sum = r.rowwise().sum();
      const Mat3 second = tet_volume(mesh, t) / 20.0 * (r * r.transpose() + sum * sum.transpose());
      inertia += second.trace() * Mat3::Identity() - second;
    }
  }

  /// Lower and upper end of a third along z [mm]; the outer ends lie beyond the body.
  [[nodiscard]] std::array<double, 2> ends(int third) const {
    const double height = (high - low) / 3.0;
    return {third == VolumeMotion::inferior ? low - height : high - (third + 1) * height,
            third == VolumeMotion::superior ? high + height : high - third * height};
  }
};

}  // namespace

Vec3 beyond_linear_turn(const Vec3& omega, const Vec3& r) {
  const double cosine = std::sqrt(std::max(0.0, 1.0 - omega.squaredNorm()));
  return omega.cross(omega.cross(r)) / (1.0 + cosine);
}

VolumeResponse::Fields VolumeResponse::loads(const TetMesh& mesh, std::span<const int> regions) {
  Fields load = Fields::Zero(3 * Eigen::Index{discretisation_->nodes()}, kFunctionals);
  const Body body(mesh, regions);
  if (body.tets.empty()) return load;
  const Mat3 to_rotation = body.inertia.inverse();
  const Quadrature rule;
  std::array<double, 3> volumes{};
  arm_.fill(Vec3::Zero());
  for (const Index t : body.tets) {
    const Corners x = corners_of(mesh, t);
    const double v = tet_volume(mesh, t);
    for (int third = 0; third < 3; ++third) {
      const auto [low, high] = body.ends(third);
      for (const TetPart& part : parts_between(x.row(2).transpose(), low, high)) {
        const double v_part = v * share_of_tet(part);
        volumes[static_cast<std::size_t>(third)] += v_part;
        arm_[static_cast<std::size_t>(third)] += v_part * (x * part.rowwise().mean() - body.centroid);
        for (std::size_t point = 0; point < rule.points.size(); ++point) {
          const Vec4 weights = part * rule.points[point];
          const Shape shape = discretisation_->shape(t, weights);
          const Mat3 turning = (to_rotation * cross_matrix(x * weights - body.centroid)).transpose();
          for (int i = 0; i < shape.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double dv = rule.weights[point] * v_part * shape.weight[k];
            auto rows = load.middleRows<3>(3 * Eigen::Index{shape.node[k]});
            rows.middleCols<3>(3 * third) += dv * Mat3::Identity();
            rows.middleCols<3>(kRotation) += dv * turning;
          }
        }
      }
    }
    // Gradients are at most linear in an element, so their mean is the gradient at the centroid.
    const ShapeGradients gradients = discretisation_->shape_gradients(t, Vec4::Constant(0.25));
    for (int i = 0; i < gradients.count; ++i)
      load.block<3, 1>(3 * Eigen::Index{gradients.node[static_cast<std::size_t>(i)]}, kDilation) +=
          v / body.volume * gradients.gradient.col(i);
  }
  for (std::size_t third = 0; third < 3; ++third) {
    share_[third] = volumes[third] / body.volume;
    if (volumes[third] == 0.0) continue;
    load.middleCols<3>(3 * static_cast<Eigen::Index>(third)) /= volumes[third];
    arm_[third] /= volumes[third];
  }
  return load;
}

VolumeResponse::VolumeResponse(const TetMesh& mesh, Element element, std::unique_ptr<Subdivision> halved)
    : halved_(std::move(halved)),
      discretisation_(detail::Discretisation::make(element, halved_ ? halved_->mesh : mesh)) {}
VolumeResponse::VolumeResponse(VolumeResponse&&) noexcept = default;
VolumeResponse& VolumeResponse::operator=(VolumeResponse&&) noexcept = default;
VolumeResponse::~VolumeResponse() = default;

Result<VolumeResponse> VolumeResponse::solve(const Tissue& tissue, std::span<const int> regions, Accuracy accuracy,
                                             const Progress& progress) {
  const TetMesh& mesh = tissue.mesh();
  if (accuracy == Accuracy::of_the_tissue) {
    VolumeResponse response(mesh, tissue.element(), nullptr);
    response.w_ = tissue.solve(response.loads(mesh, regions));
    return response;
  }
  std::vector<Index> fixed;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    if (tissue.is_fixed(node)) fixed.push_back(node);
  }
  std::unique_ptr<Subdivision> halved;
  if (accuracy == Accuracy::quadratic_halved) {
    halved = std::make_unique<Subdivision>(subdivide(mesh));
    for (std::size_t k = 0; k < halved->ends.size(); ++k) {
      if (tissue.is_fixed(halved->ends[k][0]) && tissue.is_fixed(halved->ends[k][1]))
        fixed.push_back(mesh.node_count() + static_cast<Index>(k));
    }
  }
  VolumeResponse response(mesh, Element::p2, std::move(halved));
  const TetMesh& finer = response.halved_ ? response.halved_->mesh : mesh;
  auto w = detail::solve_quadratic(*response.discretisation_, finer, tissue.materials(), fixed,
                                   response.loads(finer, regions), progress);
  if (!w) return w.error();
  response.w_ = *w;
  return response;
}

void VolumeResponse::add(const MaterialPoint& at, const Vec3& force, VolumeMotion& motion) const {
  const MaterialPoint place = halved_ ? in_subdivision(at) : at;
  const Shape shape = discretisation_->shape(place.tet, place.weights);
  Eigen::Matrix<double, kFunctionals, 1> sum = Eigen::Matrix<double, kFunctionals, 1>::Zero();
  for (int i = 0; i < shape.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum.noalias() += w_.middleRows<3>(3 * Eigen::Index{shape.node[k]}).transpose().lazyProduct(shape.weight[k] * force);
  }
  for (std::size_t third = 0; third < 3; ++third) {
    const Vec3 moved = sum.segment<3>(3 * static_cast<Eigen::Index>(third));
    motion.third_mm[third] += moved;
    motion.shift_mm += share_[third] * moved;
  }
  motion.rotation_rad += sum.segment<3>(kRotation);
  motion.dilation += sum[kDilation];
}

VolumeMotion VolumeResponse::finite(const VolumeMotion& linear) const {
  VolumeMotion motion = linear;
  const double sine = std::min(1.0, linear.rotation_rad.norm());
  if (sine == 0.0) return motion;
  const Vec3 omega = sine * linear.rotation_rad.normalized();
  for (std::size_t third = 0; third < 3; ++third) motion.third_mm[third] += beyond_linear_turn(omega, arm_[third]);
  motion.rotation_rad = std::asin(sine) / sine * omega;
  return motion;
}

}  // namespace stylet
