// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/mesh_kernel.hpp"

#include "stylet/core/parallel.hpp"
#include "stylet/coupling/near_field/half_space.hpp"
#include "stylet/fem/patch.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace stylet {

namespace {

constexpr double kUnit_MPa = 1.0;
/// Rings of elements in a patch. Quadratic elements have eight times the nodes in each.
constexpr int kRings = 3;
constexpr int kRingsOfQuadratic = 2;
/// A point force, as far as the rim can tell.
constexpr double kPoint_mm = 1e-6;

/// The outer faces that can move.
std::vector<std::array<Index, 3>> free_faces(const Tissue& tissue, const Topology& topology) {
  std::vector<std::array<Index, 3>> result;
  for (const Face& face : topology.boundary) {
    if (std::any_of(face.nodes.begin(), face.nodes.end(), [&](Index node) { return !tissue.is_fixed(node); }))
      result.push_back(face.nodes);
  }
  return result;
}

/// Edges from a free surface up to which its image counts whole, and from which on not at all: whole as far as a patch
/// reaches, since nothing else tells the kernel that the patch ends there.
double fading(double edges) {
  constexpr double whole = 3.0;
  constexpr double none = 5.0;
  const double t = std::clamp((none - edges) / (none - whole), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

MeshKernel::MeshKernel(std::shared_ptr<const Tissue> tissue, const Topology& topology)
    : tissue_(std::move(tissue)), rows_(static_cast<std::size_t>(tissue_->displacement_nodes())) {
  auto ground = std::make_shared<Ground>(
      Ground{SurfaceDistance(tissue_->mesh().nodes, free_faces(*tissue_, topology)), {}, {}, {}});
  for (const Material& material : tissue_->materials()) {
    const auto found = std::find(ground->poisson.begin(), ground->poisson.end(), material.poisson);
    ground->region_medium.push_back(static_cast<int>(found - ground->poisson.begin()));
    if (found == ground->poisson.end()) ground->poisson.push_back(material.poisson);
  }
  ground->node_tets.resize(rows_.size());
  for (Index tet = 0; tet < tissue_->mesh().tet_count(); ++tet) {
    for (const Index node : tissue_->nodes_of(tet)) ground->node_tets[static_cast<std::size_t>(node)].push_back(tet);
  }
  ground_ = std::move(ground);
}

Medium MeshKernel::medium(int number) const {
  const Material material{kUnit_MPa, ground_->poisson[static_cast<std::size_t>(number)]};
  return {material.mu(), material.poisson};
}

MeshKernel::Patch MeshKernel::patch_of(Index node) const {
  const Tissue& tissue = *tissue_;
  const auto around = [&](Index of) -> const std::vector<Index>& {
    return ground_->node_tets[static_cast<std::size_t>(of)];
  };
  const int rings = tissue.nodes_of(0).size() == 4 ? kRings : kRingsOfQuadratic;
  Patch patch;
  patch.nodes = {node};
  for (int ring = 0; ring < rings; ++ring) {
    patch.tets.clear();
    for (const Index at : patch.nodes) patch.tets.insert(patch.tets.end(), around(at).begin(), around(at).end());
    sort_unique(patch.tets);
    patch.nodes.clear();
    for (const Index tet : patch.tets) {
      const auto nodes = tissue.nodes_of(tet);
      patch.nodes.insert(patch.nodes.end(), nodes.begin(), nodes.end());
    }
    sort_unique(patch.nodes);
  }
  // Nodes with all their elements in the patch move; the others, and held ones, follow the kernel.
  for (const Index at : patch.nodes) {
    const bool inside = std::all_of(around(at).begin(), around(at).end(), [&](Index tet) {
      return std::binary_search(patch.tets.begin(), patch.tets.end(), tet);
    });
    patch.moves.push_back(inside && !tissue.is_fixed(at));
  }
  return patch;
}

MeshKernel::Row MeshKernel::unsolved_row(Index node, const Patch& patch) const {
  const Tissue& tissue = *tissue_;
  const Vec3 x = tissue.node_position(node);
  Row row;
  row.node = node;
  double length = 0.0;
  int edges = 0;
  for (const Index tet : ground_->node_tets[static_cast<std::size_t>(node)]) {
    for (const Index corner : tissue.mesh().tets[static_cast<std::size_t>(tet)]) {
      if (corner == node) continue;
      length += (tissue.mesh().nodes[static_cast<std::size_t>(corner)] - x).norm();
      ++edges;
    }
  }
  row.edge = length / edges;
  row.skin = ground_->skin.nearest(x);
  row.skin.share = fading(row.skin.depth / row.edge);
  for (std::size_t k = 0; k < patch.nodes.size(); ++k) {
    if (patch.moves[k]) row.near.push_back(patch.nodes[k]);
  }
  if (tissue.is_fixed(node)) row.near.clear();  // nothing to solve for: the kernel will do
  row.blocks.assign(ground_->poisson.size(), std::vector<Mat3>(row.near.size(), Mat3::Zero()));
  return row;
}

void MeshKernel::solve(Row& row, const Patch& patch) const {
  const Tissue& tissue = *tissue_;
  if (tissue.is_fixed(row.node)) return;
  const Vec3 x = tissue.node_position(row.node);
  std::vector<Eigen::Index> moving;
  std::vector<Eigen::Index> rim;
  for (std::size_t k = 0; k < patch.nodes.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      (patch.moves[k] ? moving : rim).push_back(3 * static_cast<Eigen::Index>(k) + axis);
  }
  const auto rim_node = [&](std::size_t k) { return patch.nodes[static_cast<std::size_t>(rim[k] / 3)]; };
  std::vector<NearSurface> at_rim;
  for (std::size_t k = 0; k < rim.size(); k += 3) {
    at_rim.push_back(ground_->skin.nearest(tissue.node_position(rim_node(k))));
    at_rim.back().share = row.skin.share;  // all around one source alike
  }
  for (int m = 0; m < static_cast<int>(ground_->poisson.size()); ++m) {
    const PatchStiffness stiffness =
        patch_stiffness(tissue, patch.tets, {kUnit_MPa, ground_->poisson[static_cast<std::size_t>(m)]});
    MatX prescribed(static_cast<Eigen::Index>(rim.size()), 3);
    for (std::size_t k = 0; k < rim.size(); k += 3) {
      const Vec3 r = tissue.node_position(rim_node(k)) - x;
      prescribed.middleRows<3>(static_cast<Eigen::Index>(k)) =
          kelvinlet(r, kPoint_mm, medium(m)) + surface_image(r, at_rim[k / 3], row.skin, kPoint_mm, medium(m));
    }
    MatX f = -stiffness.K(moving, rim) * prescribed;
    const auto own = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), row.node) - patch.nodes.begin();
    const auto load = std::find(moving.begin(), moving.end(), 3 * own) - moving.begin();
    f.middleRows<3>(load) += Mat3::Identity();
    const MatX u = stiffness.K(moving, moving).eval().llt().solve(f);
    for (std::size_t k = 0; k < row.near.size(); ++k)  // moving nodes, in this order
      row.blocks[static_cast<std::size_t>(m)][k] = u.middleRows<3>(3 * static_cast<Eigen::Index>(k));
  }
}

const Mat3* MeshKernel::find(const Row& row, Index node, int medium) const {
  const auto found = std::lower_bound(row.near.begin(), row.near.end(), node);
  if (found == row.near.end() || *found != node) return nullptr;
  return &row.blocks[static_cast<std::size_t>(medium)][static_cast<std::size_t>(found - row.near.begin())];
}

std::vector<Index> MeshKernel::missing(std::span<const Index> nodes) const {
  std::vector<Index> wanted;
  for (const Index node : nodes) {
    if (node >= 0 && node < tissue_->displacement_nodes() && !has(node)) wanted.push_back(node);
  }
  sort_unique(wanted);
  return wanted;
}

std::shared_ptr<const MeshKernel::Row> MeshKernel::make_row(Index node) const {
  const Patch patch = patch_of(node);
  auto row = std::make_shared<Row>(unsolved_row(node, patch));
  solve(*row, patch);
  return row;
}

void MeshKernel::add_nodes(std::span<const Index> nodes, const Progress& progress) {
  const std::vector<Index> wanted = missing(nodes);
  std::vector<std::shared_ptr<const Row>> fresh(wanted.size());  // taken only when all are done: progress may throw
  constexpr std::size_t together = 16;
  for_each_in_parallel((wanted.size() + together - 1) / together,
                       [&](std::size_t piece) {
                         const std::size_t end = std::min(wanted.size(), (piece + 1) * together);
                         for (std::size_t k = piece * together; k < end; ++k) fresh[k] = make_row(wanted[k]);
                       },
                       progress, "near field");
  for (std::size_t k = 0; k < wanted.size(); ++k) exchange(wanted[k], fresh[k]);
  added_.insert(added_.end(), wanted.begin(), wanted.end());
}

std::vector<double> MeshKernel::numbers() const {
  std::vector<double> all;
  for (const Index node : added_) {
    for (const auto& blocks : row(node).blocks) {
      for (const Mat3& block : blocks) all.insert(all.end(), block.data(), block.data() + block.size());
    }
  }
  return all;
}

bool MeshKernel::add_nodes(std::span<const Index> nodes, std::span<const double> numbers) {
  const std::vector<Index> wanted = missing(nodes);
  std::vector<std::shared_ptr<Row>> rows(wanted.size());
  constexpr std::size_t together = 64;
  for_each_in_parallel((wanted.size() + together - 1) / together, [&](std::size_t piece) {
    const std::size_t end = std::min(wanted.size(), (piece + 1) * together);
    for (std::size_t k = piece * together; k < end; ++k)
      rows[k] = std::make_shared<Row>(unsolved_row(wanted[k], patch_of(wanted[k])));
  });
  std::size_t at = 0;
  for (const auto& row : rows) {
    if (numbers.size() - at < 9 * media() * row->near.size()) return false;
    for (auto& blocks : row->blocks) {
      for (Mat3& block : blocks) {
        block = Eigen::Map<const Mat3>(numbers.data() + at);
        at += 9;
      }
    }
  }
  if (at != numbers.size()) return false;
  for (std::size_t k = 0; k < wanted.size(); ++k) rows_[static_cast<std::size_t>(wanted[k])] = std::move(rows[k]);
  added_.insert(added_.end(), wanted.begin(), wanted.end());
  return true;
}

Mat3 MeshKernel::operator()(Index p, Index q, int medium_number) const {
  const Row& on = row(q);
  if (const Mat3* there = find(on, p, medium_number)) {
    const Mat3* back = find(row(p), q, medium_number);
    return back != nullptr ? Mat3(0.5 * (*there + back->transpose())) : *there;  // p's patch may end before q
  }
  if (p == q) return Mat3::Zero();  // held
  const Vec3 r = tissue_->node_position(p) - tissue_->node_position(q);
  const Medium unit = medium(medium_number);
  return kelvinlet(r, kPoint_mm, unit) + surface_image(r, skin(p), on.skin, kPoint_mm, unit);
}

MeshKernel::Blur MeshKernel::blur() const {
  std::vector<double> radii;
  for (const Index node : added_) {
    const Row& own = row(node);
    if (own.near.empty() || own.skin.share > 0.0) continue;  // held, or not the medium's alone
    radii.push_back(3.0 * kelvinlet_self(medium(0)) / find(own, node, 0)->trace());
  }
  if (radii.empty()) return {};
  std::sort(radii.begin(), radii.end());
  return {radii.front(), radii[radii.size() / 2], radii.back(), static_cast<int>(radii.size())};
}

}  // namespace stylet
