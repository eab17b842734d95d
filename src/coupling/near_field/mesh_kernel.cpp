// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/mesh_kernel.hpp"

#include "stylet/core/parallel.hpp"
#include "stylet/coupling/near_field/half_space.hpp"
#include "stylet/fem/patch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {

constexpr double kUnit_MPa = 1.0;
/// Rings of elements in a patch. Quadratic elements have eight times as many nodes in each ring.
constexpr int kRings = 3;
constexpr int kRingsOfQuadratic = 2;
/// ε that stands for a point force, negligible at the distance of the rim.
constexpr double kPoint_mm = 1e-6;

/// The outer faces with at least one node that can move.
std::vector<std::array<Index, 3>> free_faces(const Tissue& tissue, const Topology& topology) {
  std::vector<std::array<Index, 3>> result;
  for (const Face& face : topology.boundary) {
    if (std::any_of(face.nodes.begin(), face.nodes.end(), [&](Index node) { return !tissue.is_fixed(node); }))
      result.push_back(face.nodes);
  }
  return result;
}

/// Weight of a free surface's image, by the distance in edges. It is whole as far as a patch reaches, because only the
/// image tells the kernel that the patch ends there.
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
  auto ground = std::make_shared<Ground>(Ground{SurfaceDistance(tissue_->mesh().nodes, free_faces(*tissue_, topology)),
                                                InterfaceDistance(*tissue_, topology),
                                                {},
                                                {},
                                                {}});
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

const NearInterfaces& MeshKernel::interfaces_of(Index node, int region) const {
  const auto& interfaces = row(node).interfaces;
  return std::find_if(interfaces.begin(), interfaces.end(), [&](const auto& of) { return of.first == region; })->second;
}

MeshKernel::Rings MeshKernel::rings_around(Index node) const {
  const Tissue& tissue = *tissue_;
  const int count = tissue.nodes_of(0).size() == 4 ? kRings : kRingsOfQuadratic;
  std::vector<char> has_tet(static_cast<std::size_t>(tissue.mesh().tet_count()), 0);
  std::vector<char> has_node(rows_.size(), 0);
  const auto around = [&](Index of) -> const std::vector<Index>& {
    return ground_->node_tets[static_cast<std::size_t>(of)];
  };
  Rings rings;
  rings.nodes = {node};
  has_node[static_cast<std::size_t>(node)] = 1;
  std::size_t begin = 0;  // first node that the last ring added
  for (int ring = 0; ring < count; ++ring) {
    const std::size_t end = rings.nodes.size();
    for (; begin < end; ++begin) {
      for (const Index tet : around(rings.nodes[begin])) {
        if (std::exchange(has_tet[static_cast<std::size_t>(tet)], char{1}) != 0) continue;
        rings.tets.push_back(tet);
        for (const Index at : tissue.nodes_of(tet)) {
          if (std::exchange(has_node[static_cast<std::size_t>(at)], char{1}) == 0) rings.nodes.push_back(at);
        }
      }
    }
  }
  std::sort(rings.tets.begin(), rings.tets.end());
  std::sort(rings.nodes.begin(), rings.nodes.end());
  // Nodes with all their elements in the patch move; other nodes, and held nodes, follow the kernel.
  for (const Index at : rings.nodes) {
    const bool inside = std::all_of(around(at).begin(), around(at).end(),
                                    [&](Index tet) { return has_tet[static_cast<std::size_t>(tet)] != 0; });
    rings.moves.push_back(inside && !tissue.is_fixed(at));
  }
  return rings;
}

MeshKernel::Row MeshKernel::unsolved_row(Index node, const Rings& rings) const {
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
  row.skin = nearest_skin(node);
  row.skin.share = fading(row.skin.depth / row.edge);
  for (const Index tet : ground_->node_tets[static_cast<std::size_t>(node)]) {
    const int region = tissue.mesh().tet_region[static_cast<std::size_t>(tet)];
    const auto is_there = [&](const auto& of) { return of.first == region; };
    if (std::none_of(row.interfaces.begin(), row.interfaces.end(), is_there))
      row.interfaces.emplace_back(region, ground_->interfaces.nearest(region, x));
  }
  row.blocks.resize(ground_->poisson.size());
  if (tissue.is_fixed(node)) return row;  // a held node needs no solution: the kernel is used
  for (std::size_t k = 0; k < rings.nodes.size(); ++k) {
    if (rings.moves[k] != 0) row.near.push_back(rings.nodes[k]);
  }
  for (const Index tet : rings.tets) {
    auto& blocks =
        row.blocks[static_cast<std::size_t>(medium_of(tissue.mesh().tet_region[static_cast<std::size_t>(tet)]))];
    if (blocks.empty()) blocks.assign(row.near.size(), Mat3::Zero());
  }
  return row;
}

void MeshKernel::solve(Row& row, const Rings& rings, const SkinAt& skin_at, Patch& patch) const {
  const Tissue& tissue = *tissue_;
  const Vec3 x = tissue.node_position(row.node);
  std::vector<Index> rim;
  std::vector<NearSurface> at_rim;
  for (std::size_t k = 0; k < rings.nodes.size(); ++k) {
    if (rings.moves[k] != 0) continue;
    rim.push_back(rings.nodes[k]);
    at_rim.push_back(skin_at(rings.nodes[k]));
    at_rim.back().share = row.skin.share;  // the same for the whole rim of one source
  }
  for (int m = 0; m < media(); ++m) {
    auto& blocks = row.blocks[static_cast<std::size_t>(m)];
    if (blocks.empty()) continue;
    MatX on_rim(3 * static_cast<Eigen::Index>(rim.size()), 3);
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Vec3 r = tissue.node_position(rim[k]) - x;
      on_rim.middleRows<3>(3 * static_cast<Eigen::Index>(k)) =
          kelvinlet(r, kPoint_mm, medium(m)) + surface_image(r, at_rim[k], row.skin, kPoint_mm, medium(m));
    }
    MatX force = MatX::Zero(3 * static_cast<Eigen::Index>(row.near.size()), 3);
    force.middleRows<3>(3 * place_of(row.node, row)).setIdentity();
    patch.assemble(tissue, rings.tets, rings.nodes, rings.moves,
                   {kUnit_MPa, ground_->poisson[static_cast<std::size_t>(m)]});
    const MatX u = patch.displacements(on_rim, std::move(force));
    for (std::size_t k = 0; k < blocks.size(); ++k) blocks[k] = u.middleRows<3>(3 * static_cast<Eigen::Index>(k));
  }
}

std::ptrdiff_t MeshKernel::place_of(Index node, const Row& row) {
  const auto found = std::lower_bound(row.near.begin(), row.near.end(), node);
  return found != row.near.end() && *found == node ? found - row.near.begin() : -1;
}

const Mat3* MeshKernel::find(const Row& row, Index node, int medium) {
  const std::ptrdiff_t place = place_of(node, row);
  return place < 0 ? nullptr : &row.blocks[static_cast<std::size_t>(medium)][static_cast<std::size_t>(place)];
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
  const Rings rings = rings_around(node);
  auto row = std::make_shared<Row>(unsolved_row(node, rings));
  Patch patch;
  solve(
      *row, rings, [&](Index at) { return nearest_skin(at); }, patch);
  return row;
}

void MeshKernel::add_nodes(std::span<const Index> nodes, const Progress& progress) {
  const std::vector<Index> wanted = missing(nodes);
  std::vector<Rings> rings(wanted.size());
  std::vector<std::shared_ptr<Row>> fresh(wanted.size());  // put into rows_ only when all are complete, because
                                                           // progress may throw
  constexpr std::size_t together = 16;
  const std::size_t pieces = (wanted.size() + together - 1) / together;
  const auto each_of_piece = [&](std::size_t piece, const auto& work) {
    const std::size_t end = std::min(wanted.size(), (piece + 1) * together);
    for (std::size_t k = piece * together; k < end; ++k) work(k);
  };
  for_each_in_parallel(pieces, [&](std::size_t piece) {
    each_of_piece(piece, [&](std::size_t k) {
      rings[k] = rings_around(wanted[k]);
      fresh[k] = std::make_shared<Row>(unsolved_row(wanted[k], rings[k]));
    });
  });
  // Patches overlap, so the nearest surface of each node is computed only once.
  std::vector<NearSurface> skin(rows_.size());
  std::vector<Index> seen;
  for (const Rings& patch : rings) seen.insert(seen.end(), patch.nodes.begin(), patch.nodes.end());
  sort_unique(seen);
  for (const Index node : seen) skin[static_cast<std::size_t>(node)] = nearest_skin(node);
  for_each_in_parallel(
      pieces,
      [&](std::size_t piece) {
        Patch patch;
        each_of_piece(piece, [&](std::size_t k) {
          solve(
              *fresh[k], rings[k], [&](Index node) { return skin[static_cast<std::size_t>(node)]; }, patch);
        });
      },
      progress, "near field");
  for (std::size_t k = 0; k < wanted.size(); ++k) rows_[static_cast<std::size_t>(wanted[k])] = std::move(fresh[k]);
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
      rows[k] = std::make_shared<Row>(unsolved_row(wanted[k], rings_around(wanted[k])));
  });
  std::size_t at = 0;
  for (const auto& row : rows) {
    for (auto& blocks : row->blocks) {
      if (numbers.size() - at < 9 * blocks.size()) return false;
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
  if (p == q) return Mat3::Zero();  // the node is held
  const Vec3 r = tissue_->node_position(p) - tissue_->node_position(q);
  const Medium unit = medium(medium_number);
  return kelvinlet(r, kPoint_mm, unit) + surface_image(r, skin(p), on.skin, kPoint_mm, unit);
}

MeshKernel::Blur MeshKernel::blur() const {
  std::vector<double> radii;
  for (const Index node : added_) {
    const Row& own = row(node);
    if (own.near.empty() || own.skin.share > 0.0) continue;  // held, or with the image of a surface
    int of = 0;
    while (own.blocks[static_cast<std::size_t>(of)].empty()) ++of;
    radii.push_back(3.0 * kelvinlet_self(medium(of)) / find(own, node, of)->trace());
  }
  if (radii.empty()) return {};
  std::sort(radii.begin(), radii.end());
  return {radii.front(), radii[radii.size() / 2], radii.back(), static_cast<int>(radii.size())};
}

}  // namespace stylet
