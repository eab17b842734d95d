// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/mesh_kernel.hpp"

#include "stylet/coupling/near_field/half_space.hpp"
#include "stylet/fem/patch.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

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

MeshKernel::Row MeshKernel::make_row(Index node) const {
  const Tissue& tissue = *tissue_;
  const Vec3 x = tissue.node_position(node);
  Row row;
  row.node = node;
  const auto around = [&](Index of) -> const std::vector<Index>& { return node_tets_[static_cast<std::size_t>(of)]; };
  double length = 0.0;
  int edges = 0;
  for (const Index tet : around(node)) {
    for (const Index corner : tissue.mesh().tets[static_cast<std::size_t>(tet)]) {
      if (corner == node) continue;
      length += (tissue.mesh().nodes[static_cast<std::size_t>(corner)] - x).norm();
      ++edges;
    }
  }
  row.edge = length / edges;
  row.skin = skin_.nearest(x);
  row.skin.share = fading(row.skin.depth / row.edge);

  const int rings = tissue.nodes_of(0).size() == 4 ? kRings : kRingsOfQuadratic;
  std::vector<Index> tets;
  std::vector<Index> reached{node};
  for (int ring = 0; ring < rings; ++ring) {
    tets.clear();
    for (const Index at : reached) tets.insert(tets.end(), around(at).begin(), around(at).end());
    sort_unique(tets);
    reached.clear();
    for (const Index tet : tets) {
      const auto nodes = tissue.nodes_of(tet);
      reached.insert(reached.end(), nodes.begin(), nodes.end());
    }
    sort_unique(reached);
  }

  // Nodes with all their elements in the patch move; the others, and held ones, follow the kernel.
  std::vector<Eigen::Index> moving;
  std::vector<Eigen::Index> rim;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const auto& tets_there = around(reached[k]);
    const bool inside = std::all_of(tets_there.begin(), tets_there.end(),
                                    [&](Index tet) { return std::binary_search(tets.begin(), tets.end(), tet); });
    const bool moves = inside && !tissue.is_fixed(reached[k]);
    if (moves) row.near.push_back(reached[k]);
    for (int axis = 0; axis < 3; ++axis) (moves ? moving : rim).push_back(3 * static_cast<Eigen::Index>(k) + axis);
  }
  if (tissue.is_fixed(node)) row.near.clear();  // nothing to solve for: the kernel will do

  std::vector<NearSurface> at_rim;
  for (std::size_t k = 0; k < rim.size(); k += 3) {
    at_rim.push_back(skin_.nearest(tissue.node_position(reached[static_cast<std::size_t>(rim[k] / 3)])));
    at_rim.back().share = row.skin.share;  // all around one source alike
  }
  for (int m = 0; m < static_cast<int>(poisson_.size()); ++m) {
    std::vector<Mat3>& blocks = row.blocks.emplace_back(row.near.size(), Mat3::Zero());
    if (tissue.is_fixed(node)) continue;
    const PatchStiffness patch = patch_stiffness(tissue, tets, {kUnit_MPa, poisson_[static_cast<std::size_t>(m)]});
    MatX prescribed(static_cast<Eigen::Index>(rim.size()), 3);
    for (std::size_t k = 0; k < rim.size(); k += 3) {
      const Vec3 r = tissue.node_position(reached[static_cast<std::size_t>(rim[k] / 3)]) - x;
      prescribed.middleRows<3>(static_cast<Eigen::Index>(k)) =
          kelvinlet(r, kPoint_mm, medium(m)) + surface_image(r, at_rim[k / 3], row.skin, kPoint_mm, medium(m));
    }
    MatX f = -patch.K(moving, rim) * prescribed;
    const auto own = std::lower_bound(reached.begin(), reached.end(), node) - reached.begin();
    const auto load = std::find(moving.begin(), moving.end(), 3 * own) - moving.begin();
    f.middleRows<3>(load) += Mat3::Identity();
    const MatX u = patch.K(moving, moving).eval().llt().solve(f);
    for (std::size_t k = 0; k < row.near.size(); ++k)
      blocks[k] = u.middleRows<3>(3 * static_cast<Eigen::Index>(k));  // moving nodes, in this order
  }
  return row;
}

const Mat3* MeshKernel::find(const Row& row, Index node, int medium) const {
  const auto found = std::lower_bound(row.near.begin(), row.near.end(), node);
  if (found == row.near.end() || *found != node) return nullptr;
  return &row.blocks[static_cast<std::size_t>(medium)][static_cast<std::size_t>(found - row.near.begin())];
}

void MeshKernel::add_nodes(std::span<const Index> nodes, const Progress& progress) {
  const std::size_t old = rows_.size();
  std::size_t done = 0;
  for (const Index node : nodes) {
    if (done++ % 16 == 0) report(progress, "near field", static_cast<double>(done) / static_cast<double>(nodes.size()));
    if (node < 0 || node >= tissue_->displacement_nodes() || has(node)) continue;
    Row row = make_row(node);
    slot_[static_cast<std::size_t>(node)] = static_cast<Index>(rows_.size());
    rows_.push_back(std::move(row));
  }
  make_symmetric(old);
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
