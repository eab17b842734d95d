// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {
namespace {

// Tolerances on barycentric weights, which scale with the element.
// A weight this close to 0 means a point on the face. Rounding of x is far smaller, 1 nm is far larger.
constexpr double kTie = 1e-10;
// Returned weights are not below minus this.
constexpr double kRounding = 1e-12;
// A path runs along a face when the weight's rate is below this share of the largest rate in the element.
constexpr double kTangent = 1e-9;
constexpr double kNever = std::numeric_limits<double>::infinity();

// Weights of a point that is outside the element only within the tolerance, clamped to the element; their sum stays 1.
Vec4 inside(Vec4 w) {
  if (w.minCoeff() >= -kRounding) return w;
  w = w.cwiseMax(0.0);
  return w / w.sum();
}

// Rates of change of the four weights of tetrahedron t along d.
Vec4 rates(const TetMesh& mesh, Index t, const Vec3& d) { return barycentric_gradients(mesh, t).transpose() * d; }

// Tells whether a path that starts with weights w and rates dw stays in the element at first: the smallest rate, over
// the largest, among the weights that are zero. It is 0 where the path runs within a face, and negative where the path
// leaves the element at once.
double headroom(const Vec4& w, const Vec4& dw) {
  const double scale = dw.cwiseAbs().maxCoeff();
  double least = kNever;
  for (int i = 0; i < 4; ++i) {
    if (w[i] <= kTie) least = std::min(least, std::abs(dw[i]) <= kTangent * scale ? 0.0 : dw[i] / scale);
  }
  return least;
}

struct Candidate {
  Index tet = -1;
  Vec4 weights = Vec4::Zero();
  double headroom = -kNever;
};

// Chooses among the tetrahedra around `node` that contain x. The one into which d leads from x has the largest headroom
// and wins. Where d leads into several tetrahedra and `region` is given, this region wins; then `preferred`, then the
// lowest number.
Candidate best_around(const Locator& locator, Index node, const Vec3& x, const Vec3& d, Index preferred,
                      int region = -1) {
  Candidate best;
  bool best_at_home = false;
  for (const Index t : locator.topology().node_tets[node]) {
    const Vec4 w = locator.weights(t, x);
    if (w.minCoeff() < -kTie) continue;
    const double room = headroom(w, rates(locator.mesh(), t, d));
    const bool at_home = room >= 0.0 && locator.mesh().tet_region[t] == region;
    const bool better =
        at_home != best_at_home ? at_home : room > best.headroom || (room == best.headroom && t == preferred);
    if (best.tet < 0 || better) {
      best = {t, w, room};
      best_at_home = at_home;
    }
  }
  return best;
}

// The node with the greatest weight. Every tetrahedron that contains the point also has this node.
Index nearest_node(const TetMesh& mesh, Index t, const Vec4& w) {
  int local = 0;
  w.maxCoeff(&local);
  return mesh.tets[t][local];
}

int ties(const Vec4& w) { return static_cast<int>((w.array() <= kTie).count()); }

// Whether the segment a + t d, 0 ≤ t ≤ 1, intersects the box.
bool meets(const Eigen::AlignedBox3d& box, const Vec3& a, const Vec3& d) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (a[axis] < box.min()[axis] || a[axis] > box.max()[axis]) return false;
      continue;
    }
    const double t0 = (box.min()[axis] - a[axis]) / d[axis];
    const double t1 = (box.max()[axis] - a[axis]) / d[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}

}  // namespace

Locator::Locator(const TetMesh& mesh, const Topology& topology) : mesh_(&mesh), topology_(&topology), tree_(mesh) {}

Vec4 Locator::weights(Index t, const Vec3& x) const {
  const auto& tet = mesh_->tets[t];
  const Vec3& origin = mesh_->nodes[tet[0]];
  const Vec3 a = mesh_->nodes[tet[1]] - origin;
  const Vec3 b = mesh_->nodes[tet[2]] - origin;
  const Vec3 c = mesh_->nodes[tet[3]] - origin;
  const Vec3 d = x - origin;
  const Vec3 a_b = a.cross(b);
  const double six_volumes = a_b.dot(c);
  const double w1 = b.cross(c).dot(d) / six_volumes;
  const double w2 = c.cross(a).dot(d) / six_volumes;
  const double w3 = a_b.dot(d) / six_volumes;
  return {1.0 - (w1 + w2 + w3), w1, w2, w3};
}

Vec3 Locator::face_normal(Index t, int local) const {
  const auto& tet = mesh_->tets[t];
  const auto& corner = kFaceVertices[local];
  const Vec3& origin = mesh_->nodes[tet[corner[0]]];
  return (mesh_->nodes[tet[corner[1]]] - origin).cross(mesh_->nodes[tet[corner[2]]] - origin).normalized();
}

std::optional<MaterialPoint> Locator::find(const Vec3& x, Index hint, const Vec3& travel) const {
  if (!x.allFinite() || mesh_->tets.empty()) return std::nullopt;
  Index found = -1;
  Vec4 w;

  // Walk through the face beyond which x lies furthest. The walk may run in circles or leave a concave mesh. In these
  // cases, and without a hint, the tree gives the answer.
  Index t = hint;
  for (int step = 0; step < 100 && t >= 0 && t < mesh_->tet_count(); ++step) {
    w = weights(t, x);
    int face = 0;
    if (w.minCoeff(&face) >= -kTie) {
      found = t;
      break;
    }
    t = topology_->neighbour[t][face];
  }

  if (found < 0) {
    // Take the tetrahedron in which the smallest weight of x is largest, so that rounding at a face does not matter.
    double best = -kTie;
    tree_.visit([&](const Eigen::AlignedBox3d& box) { return box.contains(x); },
                [&](std::span<const Index> tets) {
                  for (const Index candidate : tets) {
                    const Vec4 there = weights(candidate, x);
                    const double least = there.minCoeff();
                    if (least > best || (least == best && (found < 0 || candidate < found))) {
                      best = least;
                      found = candidate;
                      w = there;
                    }
                  }
                  return best <= kTie;
                });
  }
  if (found < 0) return std::nullopt;

  if (travel != Vec3::Zero() && ties(w) > 0) {
    const Candidate ahead = best_around(*this, nearest_node(*mesh_, found, w), x, travel, found);
    // Where travel leads out of the mesh, all elements end at x; the one already found is as good as any other.
    if (ahead.headroom >= 0.0) return MaterialPoint{ahead.tet, inside(ahead.weights)};
  }
  return MaterialPoint{found, inside(w)};
}

std::optional<Crossing> Locator::first_crossing(const Vec3& from, Index start, const Vec3& to,
                                                MaterialPoint& end) const {
  const Vec3 d = to - from;
  const int region = mesh_->tet_region[start];
  Index t = start;
  double s = 0.0;   // path parameter at which the path entered t
  int stalled = 0;  // number of steps without progress

  // The face through which the path leaves the region at parameter `at`, where it meets an edge or a node of `around`.
  // Several faces may meet there. They are ranked, and within a rank the path crosses the chosen one at the steepest
  // angle: 3. faces of this region towards the outside (if `mesh_ends`) or towards another region (otherwise); 2. if
  // the mesh ends, any outer face, because the path has no length in the other region; 1. any face of this region.
  const auto leaving_face = [&](Index around, double at, int fallback, bool mesh_ends) {
    const Vec3 x = from + at * d;
    Crossing crossing{at, around, fallback};
    int best_rank = 0;
    double steepest = 0.0;
    for (const Index c : topology_->node_tets[nearest_node(*mesh_, around, weights(around, x))]) {
      const Vec4 w = weights(c, x);
      if (w.minCoeff() < -kTie) continue;
      const bool home = mesh_->tet_region[c] == region;
      for (int i = 0; i < 4; ++i) {
        const Index other = topology_->neighbour[c][i];
        if (w[i] > kTie || (other >= 0 && mesh_->tet_region[other] == region)) continue;
        const bool outer = other < 0;
        const int rank = home && outer == mesh_ends ? 3 : outer && mesh_ends ? 2 : home ? 1 : 0;
        const double slope = face_normal(c, i).dot(d);
        if (rank == 0 || slope <= 0.0 || rank < best_rank || (rank == best_rank && slope <= steepest)) continue;
        best_rank = rank;
        steepest = slope;
        crossing.tet = c;
        crossing.local = i;
      }
    }
    return crossing;
  };

  // Each step increases s, or resolves a tie at an edge or node and ends in a tetrahedron through which the path has a
  // positive length. So the number of tetrahedra bounds the number of steps, apart from rounding, which is handled
  // below.
  for (std::int64_t step = 0; step < 2 * static_cast<std::int64_t>(mesh_->tet_count()) + 64; ++step) {
    const Vec4 w = weights(t, from);
    const Vec4 dw = rates(*mesh_, t, d);
    const double scale = dw.cwiseAbs().maxCoeff();
    double leave = kNever;
    int face = -1;
    for (int i = 0; i < 4; ++i) {
      if (dw[i] >= 0.0) continue;
      // A path within a face does not leave through this face, whatever the sign of the rounding error.
      if (-dw[i] <= kTangent * scale && std::abs(w[i] + s * dw[i]) <= kTie) continue;
      const double at = -w[i] / dw[i];
      if (at < leave) {
        leave = at;
        face = i;
      }
    }
    if (face < 0 || leave >= 1.0 || w[face] + dw[face] >= -kRounding) {
      end = {t, inside(w + dw)};
      return std::nullopt;
    }
    leave = std::max(leave, s);
    stalled = leave > s ? 0 : stalled + 1;
    s = leave;

    if (stalled > 16) {
      // Rounding makes the walk circle around an edge. Step ahead by a millionth of the element and search the tree.
      s = std::min(1.0, s + 1e-6 / scale);
      stalled = 0;
      const auto ahead = find(from + s * d, -1, d);
      if (!ahead || mesh_->tet_region[ahead->tet] != region) {
        return leaving_face(t, leave, face, !ahead);
      }
      t = ahead->tet;
      continue;
    }

    const Vec4 at_exit = w + s * dw;
    if (ties(at_exit) > 1) {
      const Vec3 x = from + s * d;
      const Candidate ahead = best_around(*this, nearest_node(*mesh_, t, at_exit), x, d, t, region);
      const bool mesh_ends = ahead.tet < 0 || ahead.headroom < 0.0;
      if (mesh_ends || mesh_->tet_region[ahead.tet] != region) return leaving_face(t, s, face, mesh_ends);
      t = ahead.tet;
      continue;
    }
    const Index next = topology_->neighbour[t][face];
    if (next < 0 || mesh_->tet_region[next] != region) return Crossing{s, t, face};
    t = next;
  }
  end = find(to, t).value_or(MaterialPoint{t, inside(weights(t, to))});
  return std::nullopt;
}

std::optional<Crossing> Locator::first_entry(const Vec3& from, const Vec3& to) const {
  const Vec3 d = to - from;
  if (mesh_->tets.empty() || d == Vec3::Zero() || !d.allFinite()) return std::nullopt;
  std::optional<Crossing> first;
  double steepest = 0.0;  // slope of the chosen face; decides between faces that meet the path at one edge

  const auto nearer_entry = [&](std::span<const Index> tets) {
    for (const Index t : tets) {
      const auto& neighbour = topology_->neighbour[t];
      if (neighbour[0] >= 0 && neighbour[1] >= 0 && neighbour[2] >= 0 && neighbour[3] >= 0) continue;
      const Vec4 w = weights(t, from);
      const Vec4 dw = rates(*mesh_, t, d);
      const double scale = dw.cwiseAbs().maxCoeff();
      for (int face = 0; face < 4; ++face) {
        // An inner face, or one that the path meets from inside.
        if (neighbour[face] >= 0 || dw[face] <= 1e-12 * scale) continue;
        double at = -w[face] / dw[face];
        if (at < 0.0 && w[face] <= kTie) at = 0.0;  // `from` lies on the face
        if (at > 1.0 && w[face] + dw[face] >= -kTie) at = 1.0;
        if (at < 0.0 || at > 1.0) continue;
        const Vec4 hit = w + at * dw;
        if (hit.minCoeff() < -kTie) continue;
        const double slope = -face_normal(t, face).dot(d);
        const double width = kTie / scale;  // parameters closer together than this belong to the same point
        if (first && (at > first->t + width ||
                      (at > first->t - width && (slope < steepest || (slope == steepest && t >= first->tet))))) {
          continue;
        }
        if (ties(hit) > 1) {
          // At an edge or node the path may only touch the body. It enters if there is mesh behind the point.
          const Vec3 x = from + at * d;
          const Candidate behind = best_around(*this, nearest_node(*mesh_, t, hit), x, d, t);
          if (behind.tet < 0 || behind.headroom < 0.0) continue;
        }
        first = Crossing{at, t, face};
        steepest = slope;
      }
    }
    return true;
  };
  tree_.visit([&](const Eigen::AlignedBox3d& box) { return meets(box, from, d); }, nearer_entry);
  return first;
}

}  // namespace stylet
