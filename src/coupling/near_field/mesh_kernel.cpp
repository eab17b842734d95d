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
    : tissue_(std::move(tissue)),
      skin_(tissue_->mesh().nodes, free_faces(*tissue_, topology)),
      node_tets_(static_cast<std::size_t>(tissue_->displacement_nodes())),
      slot_(static_cast<std::size_t>(tissue_->displacement_nodes()), -1) {
  for (const Material& material : tissue_->materials()) {
    const auto found = std::find(poisson_.begin(), poisson_.end(), material.poisson);
    region_medium_.push_back(static_cast<int>(found - poisson_.begin()));
    if (found == poisson_.end()) poisson_.push_back(material.poisson);
  }
  for (Index tet = 0; tet < tissue_->mesh().tet_count(); ++tet) {
    for (const Index node : tissue_->nodes_of(tet)) node_tets_[static_cast<std::size_t>(node)].push_back(tet);
  }
}

Medium MeshKernel::medium(int number) const {
  const Material material{kUnit_MPa, poisson_[static_cast<std::size_t>(number)]};
  return {material.mu(), material.poisson};
}

MeshKernel::Patch MeshKernel::patch_of(Index node) const {
  const Tissue& tissue = *tissue_;
  const auto around = [&](Index of) -> const std::vector<Index>& { return node_tets_[static_cast<std::size_t>(of)]; };
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

MeshKernel::Row MeshKernel::make_row(Index node, const Patch& patch) const {
  const Tissue& tissue = *tissue_;
  const Vec3 x = tissue.node_position(node);
  Row row;
  row.node = node;
  double length = 0.0;
  int edges = 0;
  for (const Index tet : node_tets_[static_cast<std::size_t>(node)]) {
    for (const Index corner : tissue.mesh().tets[static_cast<std::size_t>(tet)]) {
      if (corner == node) continue;
      length += (tissue.mesh().nodes[static_cast<std::size_t>(corner)] - x).norm();
      ++edges;
    }
  }
  row.edge = length / edges;
  row.skin = skin_.nearest(x);
  row.skin.share = fading(row.skin.depth / row.edge);
  for (std::size_t k = 0; k < patch.nodes.size(); ++k) {
    if (patch.moves[k]) row.near.push_back(patch.nodes[k]);
  }
  if (tissue.is_fixed(node)) row.near.clear();  // nothing to solve for: the kernel will do
  row.blocks.assign(poisson_.size(), std::vector<Mat3>(row.near.size(), Mat3::Zero()));
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
    at_rim.push_back(skin_.nearest(tissue.node_position(rim_node(k))));
    at_rim.back().share = row.skin.share;  // all around one source alike
  }
  for (int m = 0; m < static_cast<int>(poisson_.size()); ++m) {
    const PatchStiffness stiffness =
        patch_stiffness(tissue, patch.tets, {kUnit_MPa, poisson_[static_cast<std::size_t>(m)]});
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

void MeshKernel::add_nodes(std::span<const Index> nodes, const Progress& progress) {
  const std::vector<Index> wanted = missing(nodes);
  std::vector<Row> fresh(wanted.size());  // theirs only when all are done: progress may throw
  constexpr std::size_t together = 16;
  for_each_in_parallel((wanted.size() + together - 1) / together,
                       [&](std::size_t piece) {
                         const std::size_t end = std::min(wanted.size(), (piece + 1) * together);
                         for (std::size_t k = piece * together; k < end; ++k) {
                           const Patch patch = patch_of(wanted[k]);
                           fresh[k] = make_row(wanted[k], patch);
                           solve(fresh[k], patch);
                         }
                       },
                       progress, "near field");
  const std::size_t old = rows_.size();
  rows_.insert(rows_.end(), std::make_move_iterator(fresh.begin()), std::make_move_iterator(fresh.end()));
  for (std::size_t k = 0; k < wanted.size(); ++k)
    slot_[static_cast<std::size_t>(wanted[k])] = static_cast<Index>(old + k);
  make_symmetric(old);
}

std::vector<double> MeshKernel::numbers() const {
  std::vector<double> all;
  for (const Row& row : rows_) {
    for (const auto& blocks : row.blocks) {
      for (const Mat3& block : blocks) all.insert(all.end(), block.data(), block.data() + block.size());
    }
  }
  return all;
}

bool MeshKernel::add_nodes(std::span<const Index> nodes, std::span<const double> numbers) {
  const std::vector<Index> wanted = missing(nodes);
  std::vector<Row> rows(wanted.size());
  constexpr std::size_t together = 64;
  for_each_in_parallel((wanted.size() + together - 1) / together, [&](std::size_t piece) {
    const std::size_t end = std::min(wanted.size(), (piece + 1) * together);
    for (std::size_t k = piece * together; k < end; ++k) rows[k] = make_row(wanted[k], patch_of(wanted[k]));
  });
  std::size_t at = 0;
  for (Row& row : rows) {
    if (numbers.size() - at < 9 * poisson_.size() * row.near.size()) return false;
    for (auto& blocks : row.blocks) {
      for (Mat3& block : blocks) {
        block = Eigen::Map<const Mat3>(numbers.data() + at);
        at += 9;
      }
    }
  }
  if (at != numbers.size()) return false;
  for (Row& row : rows) {
    slot_[static_cast<std::size_t>(row.node)] = static_cast<Index>(rows_.size());
    rows_.push_back(std::move(row));
  }
  return true;
}

/// Each patch gives its own answer for a pair of nodes; the mean of the two obeys action and reaction.
void MeshKernel::make_symmetric(std::size_t first_new) {
  for (std::size_t k = first_new; k < rows_.size(); ++k) {
    Row& row = rows_[k];
    for (std::size_t i = 0; i < row.near.size(); ++i) {
      const Index other = row.near[i];
      if (!has(other)) continue;
      const auto slot = static_cast<std::size_t>(slot_[static_cast<std::size_t>(other)]);
      if (slot >= first_new && slot > k) continue;  // that row sees to it
      Row& opposite = rows_[slot];
      const auto found = std::lower_bound(opposite.near.begin(), opposite.near.end(), row.node);
      if (found == opposite.near.end() || *found != row.node) continue;
      for (std::size_t m = 0; m < row.blocks.size(); ++m) {
        Mat3& here = row.blocks[m][i];
        Mat3& there = opposite.blocks[m][static_cast<std::size_t>(found - opposite.near.begin())];
        const Mat3 mean = 0.5 * (here + there.transpose());
        here = mean;
        there = mean.transpose();
      }
    }
  }
}

Mat3 MeshKernel::operator()(Index p, Index q, int medium_number) const {
  const Row& row = rows_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(q)])];
  if (const Mat3* block = find(row, p, medium_number)) return *block;
  if (p == q) return Mat3::Zero();  // held
  const Vec3 r = tissue_->node_position(p) - tissue_->node_position(q);
  const Medium unit = medium(medium_number);
  return kelvinlet(r, kPoint_mm, unit) + surface_image(r, skin(p), row.skin, kPoint_mm, unit);
}

MeshKernel::Blur MeshKernel::blur() const {
  std::vector<double> radii;
  for (const Row& row : rows_) {
    if (row.near.empty() || row.skin.share > 0.0) continue;  // held, or not the medium's alone
    radii.push_back(3.0 * kelvinlet_self(medium(0)) / find(row, row.node, 0)->trace());
  }
  if (radii.empty()) return {};
  std::sort(radii.begin(), radii.end());
  return {radii.front(), radii[radii.size() / 2], radii.back(), static_cast<int>(radii.size())};
}

}  // namespace stylet
