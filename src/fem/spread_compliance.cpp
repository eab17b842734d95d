// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/spread_compliance.hpp"

#include "stylet/core/parallel.hpp"
#include "stylet/fem/quadratic_part.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace stylet {

namespace {

/// [mm] Distance between two samples of a way. A smaller one has no visible effect; twice as much would miss layers of
/// fat.
constexpr double kEvery_mm = 6.0;
/// [mm] Within this distance from a way, the interpolation between its samples is fully valid (Place::known = 1).
constexpr double kNear_mm = 10.0;
/// [mm] From this distance on it is not used (Place::known = 0).
constexpr double kFar_mm = 20.0;
/// Largest number of mesh nodes with which elements near the ways are made quadratic; elements of finer meshes are
/// small compared with the density.
constexpr Index kMostQuadratic = 45000;
/// [mm] Elements with a node closer to a way than this are made quadratic. More than nine tenths of a spread force act
/// within this distance.
constexpr double kQuadratic_mm = 20.0;

/// [mm] Radius ε of the density around each place.
constexpr double kDensity_mm = SpreadCompliance::kSpread_mm * 105.0 * std::numbers::pi / 512.0;
/// In units of kDensity_mm: the density is cut off there; less than a thousandth of the force lies further out.
constexpr double kReach = 5.0;

/// Equally weighted points of a tetrahedron: centres of smaller, similarly oriented ones, `parts` along each edge.
std::vector<Vec4> points_within(int parts) {
  std::vector<Vec4> points;
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; i + j < parts; ++j) {
      for (int k = 0; i + j + k < parts; ++k)
        points.emplace_back((Vec4(i, j, k, parts - 1 - i - j - k).array() + 0.25) / parts);
    }
  }
  return points;
}

/// A point of an element and its share of a unit force.
struct SpreadPoint {
  Index tet;
  Vec4 weights;
  double share;
};

/// Distributes a unit force around x [mm]. The weight of a point is the density of a Kelvinlet times Young's modulus of
/// the tissue there, so that at a border the stiffer side bears most of the force, as it does for a needle. Places
/// outside the tissue, and elements whose nodes are all held, bear none of it.
std::vector<SpreadPoint> spread_about(const Vec3& x, const Tissue& tissue) {
  const TetMesh& mesh = tissue.mesh();
  static const std::vector<Vec4> many = points_within(8);  // where the density is steep
  static const std::vector<Vec4> some = points_within(2);
  std::vector<SpreadPoint> spread;
  double sum = 0.0;
  for (Index tet = 0; tet < mesh.tet_count(); ++tet) {
    Eigen::Matrix<double, 3, 4> corners;
    for (int i = 0; i < 4; ++i)
      corners.col(i) =
          mesh.nodes[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(tet)][static_cast<std::size_t>(i)])];
    const Vec3 middle = corners.rowwise().mean();
    const double radius = std::sqrt((corners.colwise() - middle).colwise().squaredNorm().maxCoeff());
    // Lower bound of the distance; it does not depend on the orientation of the scene.
    const double off = (middle - x).norm() - radius;
    if (off > kReach * kDensity_mm) continue;
    const auto& nodes = mesh.tets[static_cast<std::size_t>(tet)];
    if (std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return tissue.is_fixed(node); })) continue;
    const double young_MPa = tissue.material(mesh.tet_region[static_cast<std::size_t>(tet)]).young_MPa;
    const std::vector<Vec4>& points = off < kDensity_mm ? many : some;
    const double volume = tet_volume(mesh, tet) / static_cast<double>(points.size());
    for (const Vec4& weights : points) {
      const double distance2 = (corners * weights - x).squaredNorm();
      spread.push_back(
          {tet, weights, young_MPa * volume * std::pow(distance2 / (kDensity_mm * kDensity_mm) + 1.0, -3.5)});
      sum += spread.back().share;
    }
  }
  for (SpreadPoint& point : spread) point.share /= sum;
  return spread;
}

}  // namespace

std::vector<SpreadCompliance::Line> SpreadCompliance::lines_of(const std::vector<NeedleWay>& ways) {
  std::vector<Line> lines;
  int first = 0;
  for (const NeedleWay& way : ways) {
    const int count = 2 + static_cast<int>(std::max(0.0, way.length_mm) / kEvery_mm);
    lines.push_back({way, first, count});
    first += count;
  }
  return lines;
}

double SpreadCompliance::Line::along(const Vec3& x) const {
  return std::clamp((x - way.entry).dot(way.direction), 0.0, kEvery_mm * static_cast<double>(count - 1));
}

double SpreadCompliance::Line::distance(const Vec3& x) const {
  return (x - way.entry - along(x) * way.direction).norm();
}

Result<MatX> SpreadCompliance::solve(const Tissue& tissue, const Line& line) {
  const Eigen::Index columns = 3 * Eigen::Index{line.count};
  std::optional<QuadraticPart> near;
  if (tissue.element() != Element::p2 && tissue.mesh().node_count() <= kMostQuadratic) {
    auto made = QuadraticPart::build(tissue, [&](const Vec3& x) { return line.distance(x) < kQuadratic_mm; });
    if (!made) return made.error();
    near = std::move(*made);
  }
  MatX on_mesh = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, columns);
  MatX on_near = MatX::Zero(near ? 3 * Eigen::Index{near->tissue().displacement_nodes()} : 0, columns);
  for_each_in_parallel(static_cast<std::size_t>(line.count), [&](std::size_t k) {
    const Vec3 x = line.way.entry + kEvery_mm * static_cast<double>(k) * line.way.direction;
    for (const SpreadPoint& point : spread_about(x, tissue)) {
      const Index inner = near ? near->number(point.tet) : -1;
      const Shape shape =
          inner < 0 ? tissue.shape(point.tet, point.weights) : near->tissue().shape(inner, point.weights);
      MatX& load = inner < 0 ? on_mesh : on_near;
      for (int i = 0; i < shape.count; ++i) {
        const auto n = static_cast<std::size_t>(i);
        load.block<3, 3>(3 * Eigen::Index{shape.node[n]}, 3 * static_cast<Eigen::Index>(k)).diagonal().array() +=
            point.share * shape.weight[n];
      }
    }
  });
  MatX M = MatX::Zero(columns, columns);
  if (near) {
    const MatX u = near->tissue().solve(on_near);
    M.noalias() += on_near.transpose() * u;
    near->add_rim_forces(on_near, u, on_mesh);
  }
  M.noalias() += on_mesh.transpose() * tissue.solve(on_mesh);
  return MatX(0.5 * (M + M.transpose()));
}

Result<SpreadCompliance> SpreadCompliance::solve(const Tissue& tissue, const std::vector<NeedleWay>& ways,
                                                 const Progress& progress) {
  SpreadCompliance result;
  result.lines_ = lines_of(ways);
  const Eigen::Index rows = 3 * Eigen::Index{result.lines_.back().first + result.lines_.back().count};
  result.matrix_ = MatX::Zero(rows, rows);
  double done = 0.0;
  for (const Line& line : result.lines_) {
    report(progress, "wide part of the near field", done++ / static_cast<double>(ways.size()));
    auto M = solve(tissue, line);
    if (!M) return M.error();
    result.matrix_.block(3 * line.first, 3 * line.first, M->rows(), M->cols()) = *M;
  }
  if (result.lines_.size() > 1) result.solve_between_lines(tissue);
  return result;
}

/// M between samples of different lines, on the elements of the mesh. Elements near a line that were made quadratic
/// yield more to the same forces, so M as a whole stays positive semidefinite.
void SpreadCompliance::solve_between_lines(const Tissue& tissue) {
  const Eigen::Index nodes = tissue.displacement_nodes();
  std::vector<Eigen::SparseMatrix<double>> loads(lines_.size());  // (nodes × samples of a line) shares of a unit force
  for_each_in_parallel(lines_.size(), [&](std::size_t l) {
    const Line& line = lines_[l];
    std::vector<Eigen::Triplet<double>> shares;
    for (int k = 0; k < line.count; ++k) {
      for (const SpreadPoint& point : spread_about(line.way.entry + kEvery_mm * k * line.way.direction, tissue)) {
        const Shape shape = tissue.shape(point.tet, point.weights);
        for (int i = 0; i < shape.count; ++i) {
          const auto n = static_cast<std::size_t>(i);
          shares.emplace_back(shape.node[n], k, point.share * shape.weight[n]);
        }
      }
    }
    loads[l].resize(nodes, line.count);
    loads[l].setFromTriplets(shares.begin(), shares.end());
  });
  for (std::size_t l = 0; l + 1 < lines_.size(); ++l) {
    const Line& on = lines_[l];
    MatX forces = MatX::Zero(3 * nodes, 3 * Eigen::Index{on.count});
    for (Eigen::Index k = 0; k < on.count; ++k) {
      for (Eigen::SparseMatrix<double>::InnerIterator share(loads[l], k); share; ++share)
        forces.block<3, 3>(3 * share.row(), 3 * k).diagonal().setConstant(share.value());
    }
    const MatX u = tissue.solve(forces);
    for_each_in_parallel(lines_.size() - l - 1, [&](std::size_t further) {
      const Line& at = lines_[l + 1 + further];
      const Eigen::SparseMatrix<double>& weights = loads[l + 1 + further];
      MatX between = MatX::Zero(3 * Eigen::Index{at.count}, u.cols());
      for (Eigen::Index k = 0; k < at.count; ++k) {
        for (Eigen::SparseMatrix<double>::InnerIterator share(weights, k); share; ++share)
          between.middleRows<3>(3 * k) += share.value() * u.middleRows<3>(3 * share.row());
      }
      matrix_.block(3 * at.first, 3 * on.first, between.rows(), between.cols()) = between;
      matrix_.block(3 * on.first, 3 * at.first, between.cols(), between.rows()) = between.transpose();
    });
  }
}

std::shared_ptr<const SpreadCompliance> SpreadCompliance::of(const std::vector<NeedleWay>& ways, MatX matrix) {
  auto result = std::make_shared<SpreadCompliance>();
  result->lines_ = lines_of(ways);
  const Eigen::Index rows = 3 * Eigen::Index{result->lines_.back().first + result->lines_.back().count};
  if (matrix.rows() != rows || matrix.cols() != rows) return nullptr;
  const Eigen::Index first = 3 * Eigen::Index{result->lines_.front().count};
  if (rows > first && matrix.topRightCorner(first, rows - first).isZero(0.0)) return nullptr;
  result->matrix_ = std::move(matrix);
  return result;
}

int SpreadCompliance::way_near(const Vec3& x) const {
  const auto nearer = [&](const Line& a, const Line& b) { return a.distance(x) < b.distance(x); };
  return static_cast<int>(std::min_element(lines_.begin(), lines_.end(), nearer) - lines_.begin());
}

SpreadCompliance::Place SpreadCompliance::place(const Vec3& x, int way) const {
  const Line& line = lines_[static_cast<std::size_t>(way)];
  const double depth = line.along(x) / kEvery_mm;
  Place place;
  const int before = std::min(static_cast<int>(depth), line.count - 2);
  const double t = depth - before;
  place.weight = {((1.0 - 0.5 * t) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0, ((2.0 - 1.5 * t) * t + 0.5) * t,
                  (0.5 * t - 0.5) * t * t};
  for (int k = 0; k < 4; ++k)
    place.sample[static_cast<std::size_t>(k)] = line.first + std::clamp(before - 1 + k, 0, line.count - 1);
  const double left = std::clamp((kFar_mm - line.distance(x)) / (kFar_mm - kNear_mm), 0.0, 1.0);
  place.known = left * left * (3.0 - 2.0 * left);
  return place;
}

Mat3 SpreadCompliance::operator()(const Place& at, const Place& on) const {
  Mat3 sum = Mat3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t l = 0; l < 4; ++l)
      sum += at.weight[k] * on.weight[l] * matrix_.block<3, 3>(3 * at.sample[k], 3 * on.sample[l]);
  }
  return sum;
}

void SpreadCompliance::press(const Place& on, MatX& under) const {
  const auto per_force_on = [&](std::size_t l) { return matrix_.middleCols<3>(3 * Eigen::Index{on.sample[l]}); };
  under = on.weight[0] * per_force_on(0) + on.weight[1] * per_force_on(1) + on.weight[2] * per_force_on(2) +
          on.weight[3] * per_force_on(3);
}

Mat3 SpreadCompliance::at(const Place& place, const MatX& under) {
  Mat3 sum = Mat3::Zero();
  for (std::size_t k = 0; k < 4; ++k) sum += place.weight[k] * under.middleRows<3>(3 * Eigen::Index{place.sample[k]});
  return sum;
}

}  // namespace stylet
