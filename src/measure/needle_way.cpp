// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_way.hpp"

#include "stylet/coupling/track_compliance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace stylet::measure {

namespace {

constexpr double kFineStep_mm = 0.05;

/// The local number of the corner of `element` that `other` does not have; −1 unless the two share a face.
int opposite(const std::array<Index, 4>& element, const std::array<Index, 4>& other) {
  int found = -1;
  for (int i = 0; i < 4; ++i) {
    if (std::find(other.begin(), other.end(), element[static_cast<std::size_t>(i)]) != other.end()) continue;
    if (found >= 0) return -1;
    found = i;
  }
  return found;
}

/// Follows the way and keeps the places at which a node can be added.
class Walk {
 public:
  Walk(const NeedleWay& way, const RemeshCostOptions& options)
      : way_(way),
        options_(options),
        locator_(*way.locator),
        direction_((way.to - way.from).normalized()),
        length_((way.to - way.from).norm()),
        mesh_(locator_),
        accepts_(way.store, locator_, options.most_nodes) {}

  std::vector<AddedNode> nodes() {
    options_.placement == Placement::face ? on_faces() : inside();
    return std::move(nodes_);
  }

 private:
  [[nodiscard]] Vec3 at(double s) const { return way_.from + s * direction_; }
  [[nodiscard]] bool full() const { return static_cast<int>(nodes_.size()) >= options_.most_nodes; }

  void inside() {
    for (double s = 0.5 * options_.spacing_mm; s < length_ && !full(); s += options_.spacing_mm) try_add_near(at(s));
  }

  /// Adds a node at x, or a little beside the way if x is too near a face.
  void try_add_near(const Vec3& x) {
    const Vec3 u = direction_.unitOrthogonal();
    const Vec3 v = direction_.cross(u);
    for (const double radius : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0}) {
      for (int k = 0; k < (radius > 0.0 ? 12 : 1); ++k) {
        const double angle = k * std::numbers::pi / 6.0;
        const Vec3 beside = x + radius * (std::cos(angle) * u + std::sin(angle) * v);
        const auto place = locator_.find(beside, -1, direction_);
        if (place && try_add(*place, beside)) return;
      }
    }
  }

  void on_faces() {
    auto before = locator_.find(at(0.0), -1, direction_);
    double last = -options_.spacing_mm;
    for (double s = kFineStep_mm; s < length_ && !full(); s += kFineStep_mm) {
      const auto here = locator_.find(at(s), before ? before->tet : -1, direction_);
      if (before && here && before->tet != here->tet && s - last >= options_.spacing_mm) {
        const auto& tets = locator_.mesh().tets;
        const int local =
            opposite(tets[static_cast<std::size_t>(before->tet)], tets[static_cast<std::size_t>(here->tet)]);
        if (local >= 0) {
          const double from = locator_.weights(before->tet, at(s - kFineStep_mm))[local];
          const double to = locator_.weights(before->tet, at(s))[local];
          const Vec3 x = at(s - kFineStep_mm + kFineStep_mm * from / (from - to));
          if (try_add({before->tet, locator_.weights(before->tet, x)}, x)) last = s;
        }
      }
      before = here;
    }
  }

  bool try_add(const MaterialPoint& point, const Vec3& x) {
    AddedNode node{.at = point, .x = x, .travel = direction_, .change = {}, .dofs = {}};
    if (options_.placement == Placement::face) {
      constexpr double nudge = 1e-5;
      const Index one = mesh_.find(x - nudge * direction_, point.tet);
      const Index two = mesh_.find(x + nudge * direction_, point.tet);
      if (one < 0 || two < 0 || one == two) return false;
      const int local_one = opposite(mesh_.element(one).nodes, mesh_.element(two).nodes);
      const int local_two = opposite(mesh_.element(two).nodes, mesh_.element(one).nodes);
      if (local_one < 0 || local_two < 0) return false;
      if (accepts_.add(point, x, Placement::face, direction_).point < 0) return false;
      node.change = mesh_.split_face(one, local_one, two, local_two, x);
    } else {
      const Index element = mesh_.find(x, point.tet);
      if (element < 0 || accepts_.add(point, x, Placement::interior).point < 0) return false;
      node.change = mesh_.split_inside(element, x);
    }
    add_dofs(node);
    nodes_.push_back(std::move(node));
    return true;
  }

  void add_dofs(AddedNode& node) const {
    const Tissue& tissue = way_.store->tissue();
    const Index base = tissue.mesh().node_count();
    std::set<Index> involved;
    for (const auto& element : node.change.after) involved.insert(element.nodes.begin(), element.nodes.end());
    for (const Index a : involved) {
      const Index first = a < base ? tissue.first_dof(a) : tissue.free_dofs() + 3 * (a - base);
      if (first >= 0) node.dofs.insert(node.dofs.end(), {first, first + 1, first + 2});
    }
    std::sort(node.dofs.begin(), node.dofs.end());
  }

  const NeedleWay& way_;
  const RemeshCostOptions& options_;
  const Locator& locator_;
  Vec3 direction_;
  double length_;
  paper::AdaptedMesh mesh_;
  TrackCompliance accepts_;
  std::vector<AddedNode> nodes_;
};

}  // namespace

std::vector<AddedNode> nodes_along(const NeedleWay& way, const RemeshCostOptions& options) {
  return Walk(way, options).nodes();
}

MatX stiffness_change(const Tissue& tissue, const AddedNode& node) {
  const TetMesh& mesh = tissue.mesh();
  const Index base = mesh.node_count();
  const auto k = static_cast<Eigen::Index>(node.dofs.size());
  MatX change = MatX::Zero(k, k);
  const auto add = [&](const paper::AdaptedMesh::Element& element, double sign) {
    std::array<Eigen::Index, 4> at{};  // position of each corner's rows in ΔK, −1 if it is held
    for (std::size_t i = 0; i < 4; ++i) {
      const Index a = element.nodes[i];
      const Index first = a < base ? tissue.first_dof(a) : tissue.free_dofs() + 3 * (a - base);
      at[i] = first < 0 ? -1 : std::lower_bound(node.dofs.begin(), node.dofs.end(), first) - node.dofs.begin();
    }
    const Material& material = tissue.material(mesh.tet_region[static_cast<std::size_t>(element.base_tet)]);
    for (int a = 0; a < 4; ++a) {
      const Eigen::Index row = at[static_cast<std::size_t>(a)];
      if (row < 0) continue;
      for (int b = a; b < 4; ++b) {
        const Eigen::Index column = at[static_cast<std::size_t>(b)];
        if (column < 0) continue;
        const Mat3 block = sign * element_block(element.gradients, element.volume, material, a, b);
        change.block<3, 3>(row, column) += block;
        if (a != b) change.block<3, 3>(column, row) += block.transpose();
      }
    }
  };
  for (const auto& element : node.change.before) add(element, -1.0);
  for (const auto& element : node.change.after) add(element, 1.0);
  return change;
}

}  // namespace stylet::measure
