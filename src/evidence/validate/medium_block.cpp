// SPDX-License-Identifier: GPL-3.0-or-later
#include "medium_block.hpp"

#include "solids.hpp"
#include "stylet/coupling/laws.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace stylet::validate {

namespace {

/// Moves to each plane the nearest layer of nodes that has not been moved to another plane.
void move_layers(TetMesh& mesh, const std::vector<double>& planes) {
  std::set<double> layers;
  for (const Vec3& x : mesh.nodes) layers.insert(x.z());
  for (const double plane : planes) {
    const auto nearer = [&](double a, double b) { return std::abs(a - plane) < std::abs(b - plane); };
    const double layer = *std::min_element(layers.begin(), layers.end(), nearer);
    for (Vec3& x : mesh.nodes) {
      if (x.z() == layer) x.z() = plane;
    }
    layers.erase(layer);
  }
}

}  // namespace

Result<MediumBlock> MediumBlock::build(const Options& options) {
  MediumBlock block;
  TetMesh mesh = box_mesh(Vec3::Constant(-kHalf_mm), Vec3::Constant(kHalf_mm),
                          {options.cells, options.cells, options.cells}, options.jitter);
  move_layers(mesh, options.faces_at_z);
  assign_regions(mesh, options.regions, options.region_at);
  block.fixed = nodes_where(mesh, [&](const Vec3& x) {
    constexpr double face = kHalf_mm - 0.01;
    const bool side = std::max(std::abs(x.x()), std::abs(x.y())) > face || x.z() > face;
    return side || (!options.skin && x.z() < -face) || options.also_held(x);
  });
  auto materials = options.materials;
  if (materials.empty()) materials = {{kYoung_MPa, options.poisson}};
  auto built = Tissue::build(std::move(mesh), materials, block.fixed, {}, options.element);
  if (!built) return built.error();
  block.tissue = std::make_shared<const Tissue>(std::move(*built));
  block.fixed = block.tissue->fixed_nodes();
  block.topology = std::make_unique<Topology>(block.tissue->mesh());
  block.locator = std::make_unique<Locator>(block.tissue->mesh(), *block.topology);
  block.store = std::make_shared<ComplianceStore>(block.tissue);
  block.kernel = std::make_shared<MeshKernel>(block.tissue, *block.topology);
  if (!options.ways.empty()) {
    auto spread = SpreadCompliance::solve(*block.tissue, options.ways);
    if (!spread) return spread.error();
    block.spread = std::make_shared<const SpreadCompliance>(std::move(*spread));
  }
  block.medium = {block.tissue->material(0).mu(), block.tissue->material(0).poisson};
  return block;
}

MaterialPoint MediumBlock::at(const Vec3& x) const { return locator->find(x, -1, Vec3::UnitZ()).value(); }

std::vector<Index> MediumBlock::corners_around(const std::vector<Vec3>& points) const {
  std::vector<Index> nodes;
  for (const Vec3& x : points) {
    const auto corners = tissue->nodes_of(at(x).tet);
    nodes.insert(nodes.end(), corners.begin(), corners.end());
  }
  return nodes;
}

void MediumBlock::prepare(const std::vector<Vec3>& points) {
  const auto nodes = corners_around(points);
  store->add_nodes(nodes);
  kernel->add_nodes(nodes);
}

NearFieldCompliance MediumBlock::compliance(const NeedleKernel& needle, int capacity) const {
  return {std::make_unique<TrackCompliance>(store, *locator, capacity),
          tissue,
          kernel,
          needle,
          capacity,
          {},
          false,
          spread};
}

MatX MediumBlock::reactions(const Vec3& x) const {
  const MaterialPoint point = at(x);
  const Shape shape = tissue->shape(point.tet, point.weights);
  MatX f = MatX::Zero(3 * Eigen::Index{tissue->displacement_nodes()}, 3);
  for (int k = 0; k < shape.count; ++k) {
    f.middleRows<3>(3 * Eigen::Index{shape.node[static_cast<std::size_t>(k)]}) +=
        shape.weight[static_cast<std::size_t>(k)] * Mat3::Identity();
  }
  const MatX u = tissue->solve(f);
  MatX result(3 * static_cast<Eigen::Index>(fixed.size()), 3);
  for (int axis = 0; axis < 3; ++axis) {
    const VecX reaction = tissue->support_forces(u.col(axis));
    for (std::size_t b = 0; b < fixed.size(); ++b)
      result.col(axis).segment<3>(3 * static_cast<Eigen::Index>(b)) = reaction.segment<3>(3 * Eigen::Index{fixed[b]});
  }
  return result;
}

Mat3 MediumBlock::lift(const Vec3& x, const std::vector<Mat3>& field) const {
  const MatX felt = reactions(x);
  Mat3 lifted = Mat3::Zero();
  for (std::size_t b = 0; b < field.size(); ++b)
    lifted -= felt.middleRows<3>(3 * static_cast<Eigen::Index>(b)).transpose() * field[b];
  return lifted;
}

Mat3 MediumBlock::tip(const NeedleKernel& needle, const Vec3& x) {
  prepare({x});
  NearFieldCompliance contacts = compliance(needle, 1);
  if (!contacts.move_tip(at(x), x)) throw std::logic_error("the tip was refused");
  return contacts(0, 0);
}

Mat3 MediumBlock::tip_moves(const NeedleKernel& needle, const Vec3& x, const Vec3& seen) {
  prepare({x, seen});
  NearFieldCompliance contacts = compliance(needle, 1);
  if (!contacts.move_tip(at(x), x)) throw std::logic_error("the tip was refused");
  return contacts(contacts.add(at(seen), seen, Placement::embedded).point, 0);
}

namespace {

/// Lays the points of a needle line without near field, as an insertion does.
class Layer {
 public:
  Layer(MediumBlock& block, const NeedleLine::Options& options, int capacity)
      : block_(block), options_(options), contacts_(block.store, *block.locator, capacity) {}

  /// Lays a point at x by the method, or by interpolation if no node can be added. Leaves it out if its compliance
  /// follows from the points before it.
  void lay(const Vec3& x) {
    if (options_.method == NeedleLine::Method::node_addition && lay_node(x)) return;
    block_.prepare_mesh({x});
    const int point = contacts_.add(block_.at(x), x, Placement::embedded).point;
    std::vector<int> before;
    for (int k = point - 1; k > 0 && before.size() < ContactCompliance::kNeighbours; --k) before.push_back(k);
    if (contacts_.independence(point, before) < CouplingSettings{}.independence)
      contacts_.remove_last_embedded();
    else
      points.push_back(x);
  }

  /// Compliance among the laid points.
  [[nodiscard]] MatX matrix() const {
    const auto size = 3 * static_cast<Eigen::Index>(points.size());
    return contacts_.matrix().block(3, 3, size, size);
  }

  std::vector<Vec3> points;

 private:
  /// Adds a node inside an element, at x or as near to x along the line as the elements allow.
  bool lay_node(const Vec3& x) {
    constexpr double step_mm = 0.05;
    const double farthest = 0.45 * options_.spacing_mm;
    for (double off = 0.0; off<farthest; off = off> 0.0 ? -off : step_mm - off) {
      const Vec3 there = x + off * options_.direction;
      block_.prepare_mesh({there});
      if (contacts_.add(block_.at(there), there, Placement::interior).point < 0) continue;
      points.push_back(there);
      return true;
    }
    return false;
  }

  MediumBlock& block_;
  NeedleLine::Options options_;
  TrackCompliance contacts_;
};

}  // namespace

NeedleLine NeedleLine::build(MediumBlock& block, Options options) {
  options.direction.normalize();
  NeedleLine line;
  line.direction = options.direction;
  const int wanted = static_cast<int>(std::lround(kLength_mm / options.spacing_mm));
  const NeedleKernel needle{.segment_mm = options.spacing_mm};
  for (int k = 0; k < wanted; ++k)
    line.points.emplace_back(Vec3(1.3, 0.7, 0.0) +
                             (options.spacing_mm * (k + 0.5) - 0.5 * kLength_mm) * line.direction);
  if (options.method == Method::near_field) {
    block.prepare(line.points);
    NearFieldCompliance contacts = block.compliance(needle, wanted);
    for (const Vec3& x : line.points) contacts.add(block.at(x), x, Placement::embedded, line.direction);
    line.A = contacts.matrix().block(3, 3, 3 * wanted, 3 * wanted);
  } else {
    Layer layer(block, options, wanted);
    for (const Vec3& x : line.points) layer.lay(x);
    line.A = layer.matrix();
    line.points = layer.points;
  }
  if (!options.unbounded) return line;

  const auto count = static_cast<int>(line.points.size());
  MatX field(3 * static_cast<Eigen::Index>(block.fixed.size()), 3 * count);
  for (int d = 0; d < count; ++d) {
    const Segment piece{line.points[static_cast<std::size_t>(d)], line.direction, options.spacing_mm};
    for (std::size_t b = 0; b < block.fixed.size(); ++b) {
      const Segment node{block.tissue->node_position(block.fixed[b]), line.direction, 0.0};
      field.block<3, 3>(3 * static_cast<Eigen::Index>(b), 3 * d) =
          kelvinlet(node, piece, line.direction, needle.shaft_epsilon(), block.medium);
    }
  }
  MatX lifted(3 * count, 3 * count);
  for (int c = 0; c < count; ++c)
    lifted.middleRows<3>(3 * c) = -block.reactions(line.points[static_cast<std::size_t>(c)]).transpose() * field;
  line.A += 0.5 * (lifted + lifted.transpose());
  return line;
}

double NeedleLine::force(const Vec3& along) const {
  const Eigen::Index count = A.rows() / 3;
  const VecX u = (kWay_mm * along).replicate(count, 1);
  return u.dot(VecX(A.ldlt().solve(u))) / kWay_mm;
}

}  // namespace stylet::validate
