// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/mean_displacement.hpp"

#include "discretisation.hpp"
#include "quadratic_solve.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// Mean of every node's shape function over the volume, in each direction by itself (3n × 3): exact up to quadratic
/// elements.
MatX uniform_load(const detail::Discretisation& discretisation, const TetMesh& mesh, std::span<const int> regions) {
  MatX load = MatX::Zero(3 * Eigen::Index{discretisation.nodes()}, 3);
  double volume = 0.0;
  const double inner = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0;  // four points, exact for quadratic functions
  const double outer = (5.0 - std::sqrt(5.0)) / 20.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const int region = mesh.tet_region[static_cast<std::size_t>(t)];
    if (std::find(regions.begin(), regions.end(), region) == regions.end()) continue;
    const double v = tet_volume(mesh, t);
    volume += v;
    for (int point = 0; point < 4; ++point) {
      Vec4 weights = Vec4::Constant(outer);
      weights[point] = inner;
      const Shape shape = discretisation.shape(t, weights);
      for (int i = 0; i < shape.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        load.middleRows<3>(3 * Eigen::Index{shape.node[k]}) += 0.25 * v * shape.weight[k] * Mat3::Identity();
      }
    }
  }
  if (volume > 0.0) load /= volume;
  return load;
}

}  // namespace

MeanDisplacement::MeanDisplacement(const TetMesh& mesh, Element element, std::unique_ptr<Subdivision> halved)
    : halved_(std::move(halved)),
      discretisation_(detail::Discretisation::make(element, halved_ ? halved_->mesh : mesh)) {}
MeanDisplacement::MeanDisplacement(MeanDisplacement&&) noexcept = default;
MeanDisplacement& MeanDisplacement::operator=(MeanDisplacement&&) noexcept = default;
MeanDisplacement::~MeanDisplacement() = default;

Result<MeanDisplacement> MeanDisplacement::solve(const Tissue& tissue, std::span<const int> regions, Accuracy accuracy,
                                                 const Progress& progress) {
  const TetMesh& mesh = tissue.mesh();
  if (accuracy == Accuracy::of_the_tissue) {
    MeanDisplacement mean(mesh, tissue.element(), nullptr);
    mean.w_ = tissue.solve(uniform_load(*mean.discretisation_, mesh, regions));
    return mean;
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
  MeanDisplacement mean(mesh, Element::p2, std::move(halved));
  const TetMesh& finer = mean.halved_ ? mean.halved_->mesh : mesh;
  auto w = detail::solve_quadratic(*mean.discretisation_, finer, tissue.materials(), fixed,
                                   uniform_load(*mean.discretisation_, finer, regions), progress);
  if (!w) return w.error();
  mean.w_ = std::move(*w);
  return mean;
}

Mat3 MeanDisplacement::per_force(const MaterialPoint& at) const {
  const MaterialPoint place = halved_ ? in_subdivision(at) : at;
  const Shape shape = discretisation_->shape(place.tet, place.weights);
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < shape.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum += shape.weight[k] * w_.middleRows<3>(3 * Eigen::Index{shape.node[k]}).transpose();
  }
  return sum;
}

}  // namespace stylet
