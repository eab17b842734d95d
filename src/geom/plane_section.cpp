// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/plane_section.hpp"

#include "geom/self_crossing.hpp"

#include <Eigen/Geometry>
#include <boost/polygon/polygon.hpp>

#include <algorithm>
#include <cmath>

namespace stylet::detail {

namespace {

namespace bp = boost::polygon;
using namespace bp::operators;  // NOLINT(google-build-using-namespace): the library's + - & of areas
using Area = bp::polygon_set_data<int>;

constexpr double kGrid_mm = 1e-4;         // areas are combined on whole multiples of this, which makes that exact
constexpr double kSameOutline_mm = 0.25;  // outlines with a smaller mean distance are the same outline
constexpr double kSameArea = 0.2;         // … if their areas differ by at most this share
constexpr double kSliver = 0.05;          // share of a contour's area that may stick out of the one around it
constexpr double kTouching_mm = 0.05;     // edges that overlap by less than this only touch

int grid(double mm) { return static_cast<int>(std::lround(mm / kGrid_mm)); }

double perimeter(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) sum += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
  return sum;
}

/// The points inside a polygon that does not cross itself.
Area area_of(const Polygon& polygon) {
  std::vector<bp::point_data<int>> points;
  for (const Eigen::Vector2d& p : polygon) points.emplace_back(grid(p.x()), grid(p.y()));
  bp::polygon_data<int> one;
  bp::set_points(one, points.begin(), points.end());
  Area area;
  area.insert(one);
  return area;
}

/// The points that an odd number of polygons surround.
Area area_of(const std::vector<Polygon>& polygons) {
  Area all;
  for (const Polygon& polygon : polygons) all ^= area_of(polygon);
  return all;
}

/// Divides a polygon at its crossings with itself into polygons without crossings.
std::vector<Polygon> without_crossings(const Polygon& polygon) {
  std::vector<Polygon> done;
  std::vector<Polygon> open{polygon};
  while (!open.empty()) {
    const Polygon next = std::move(open.back());
    open.pop_back();
    const auto crossing = find_self_crossing(next, kGrid_mm);
    if (!crossing) {
      done.push_back(next);
      continue;
    }
    const auto at = [&](std::size_t k) { return next.begin() + static_cast<std::ptrdiff_t>(k); };
    Polygon loop(at(crossing->first_edge + 1), at(crossing->second_edge + 1));
    Polygon rest(next.begin(), at(crossing->first_edge + 1));
    rest.push_back(crossing->point);
    rest.insert(rest.end(), at(crossing->second_edge + 1), next.end());
    loop.push_back(crossing->point);
    open.push_back(std::move(loop));
    open.push_back(std::move(rest));
  }
  return done;
}

template <class Points>
Polygon polygon_of(const Points& points) {
  Polygon polygon;
  for (auto p = points.begin(); p != points.end(); ++p) {
    const Eigen::Vector2d x(p->x() * kGrid_mm, p->y() * kGrid_mm);
    if (polygon.empty() || polygon.back() != x) polygon.push_back(x);
  }
  while (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
  return polygon;
}

struct Outlines {
  std::vector<Polygon> polygons;
  double area_mm2 = 0;
  int parts = 0;
};

Outlines outlines_of(const Area& area) {
  std::vector<bp::polygon_with_holes_data<int>> parts;
  area.get(parts);
  Outlines out;
  for (const auto& part : parts) {
    Polygon outer = polygon_of(part);
    const double size = std::abs(signed_area(outer));
    if (size < kGrid_mm) continue;
    out.area_mm2 += size;
    ++out.parts;
    out.polygons.push_back(std::move(outer));
    for (auto hole = part.begin_holes(); hole != part.end_holes(); ++hole) {
      Polygon inner = polygon_of(*hole);
      const double missing = std::abs(signed_area(inner));
      if (missing < kGrid_mm) continue;
      out.area_mm2 -= missing;
      out.polygons.push_back(std::move(inner));
    }
  }
  return out;
}

double size_of(const Area& area) { return outlines_of(area).area_mm2; }

bool surrounds(const Polygon& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto& a = polygon[i];
    const auto& b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

/// Whether most points of `inner`, corners and middles of sides, lie inside `outer`.
bool mostly_inside(const Polygon& inner, const Polygon& outer) {
  int votes = 0;
  for (std::size_t k = 0; k < inner.size(); ++k) {
    for (const Eigen::Vector2d& p : {inner[k], Eigen::Vector2d(0.5 * (inner[k] + inner[(k + 1) % inner.size()]))})
      votes += surrounds(outer, p) ? 1 : -1;
  }
  return votes > 0;
}

/// Whether an edge of a crosses an edge of b by more than a touch.
bool cross(const Polygon& a, const Polygon& b, const Eigen::AlignedBox2d& common) {
  struct Edge {
    Eigen::Vector2d from, to;
    Eigen::AlignedBox2d box;
  };
  const auto edges_of = [&](const Polygon& polygon) {
    std::vector<Edge> edges;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      Edge edge{polygon[k], polygon[(k + 1) % polygon.size()], {}};
      edge.box.extend(edge.from).extend(edge.to);
      if (edge.box.intersects(common)) edges.push_back(edge);
    }
    return edges;
  };
  // Distance of p from the line of an edge, with a sign for the side.
  const auto off = [](const Edge& e, const Eigen::Vector2d& p) {
    const Eigen::Vector2d along = (e.to - e.from).normalized();
    return along.x() * (p.y() - e.from.y()) - along.y() * (p.x() - e.from.x());
  };
  const auto parts = [&](const Edge& e, const Edge& f) {
    const double p = off(e, f.from);
    const double q = off(e, f.to);
    return p * q < 0 && std::min(std::abs(p), std::abs(q)) > 0;
  };
  const std::vector<Edge> first = edges_of(a);
  for (const Edge& f : edges_of(b)) {
    for (const Edge& e : first) {
      if (e.box.intersects(f.box) && parts(e, f) && parts(f, e)) return true;
    }
  }
  return false;
}

enum class Relation { apart, first_inside, second_inside, same, overlapping };

/// One contour of the plane.
struct Piece {
  const Polygon* polygon;
  Eigen::AlignedBox2d box;
  double area;
  double perimeter;
  int depth = 0;  ///< number of contours around it, along the longest chain
  bool drop = false;
};

Relation relation_of(const Piece& a, const Piece& b, bool& exact) {
  const Eigen::AlignedBox2d common = a.box.intersection(b.box);
  if (common.isEmpty()) return Relation::apart;
  const double smaller = std::min(a.area, b.area);
  const double larger = std::max(a.area, b.area);
  const bool alike = smaller > (1 - kSameArea) * larger;
  if (!alike && !cross(*a.polygon, *b.polygon, common)) {
    if (mostly_inside(*b.polygon, *a.polygon)) return Relation::second_inside;
    return mostly_inside(*a.polygon, *b.polygon) ? Relation::first_inside : Relation::apart;
  }
  const double both = size_of(area_of(*a.polygon) & area_of(*b.polygon));
  if (alike && a.area + b.area - 2 * both <= kSameOutline_mm * std::min(a.perimeter, b.perimeter) &&
      a.area + b.area - 2 * both <= kSameArea * larger)
    return Relation::same;
  const Piece& small = a.area < b.area ? a : b;
  const double sliver = std::min(kSameOutline_mm * small.perimeter, kSliver * small.area);
  const double outside = small.area - both;
  if (outside <= sliver) {
    exact = exact && outside <= kTouching_mm * kTouching_mm;
    return &small == &b ? Relation::second_inside : Relation::first_inside;
  }
  if (both <= sliver) {
    exact = exact && both <= kTouching_mm * kTouching_mm;
    return Relation::apart;
  }
  exact = false;
  return Relation::overlapping;
}

/// The pieces of a plane, without those that occur twice, and how they lie to each other.
struct Arrangement {
  std::vector<Piece> pieces;
  std::vector<std::vector<std::size_t>> around;  ///< (pieces) the pieces that surround it
  std::vector<bool> overlaps;                    ///< (pieces) whether it overlaps another one in part
  bool exact = true;                             ///< whether no two outlines cross
  int twice = 0;
};

Arrangement arrange(const std::vector<Polygon>& contours) {
  Arrangement out;
  std::vector<Piece> all;
  for (const Polygon& polygon : contours) {
    Piece piece{&polygon, {}, std::abs(signed_area(polygon)), perimeter(polygon)};
    for (const Eigen::Vector2d& p : polygon) piece.box.extend(p);
    all.push_back(piece);
  }
  // The contour with the most points stays of those that occur twice.
  std::stable_sort(all.begin(), all.end(),
                   [](const Piece& a, const Piece& b) { return a.polygon->size() > b.polygon->size(); });
  for (const Piece& piece : all) {
    std::vector<std::size_t> mine;
    std::vector<std::size_t> inside_me;
    bool same = false;
    bool overlaps = false;
    bool exact = out.exact;
    std::vector<std::size_t> partners;
    for (std::size_t k = 0; k < out.pieces.size() && !same; ++k) {
      switch (relation_of(out.pieces[k], piece, exact)) {
        case Relation::apart:
          break;
        case Relation::first_inside:
          inside_me.push_back(k);
          break;
        case Relation::second_inside:
          mine.push_back(k);
          break;
        case Relation::same:
          same = true;
          break;
        case Relation::overlapping:
          overlaps = true;
          partners.push_back(k);
          break;
      }
    }
    if (same) {
      ++out.twice;
      continue;
    }
    const std::size_t number = out.pieces.size();
    out.exact = exact;
    out.pieces.push_back(piece);
    out.around.push_back(std::move(mine));
    out.overlaps.push_back(overlaps);
    for (const std::size_t k : inside_me) out.around[k].push_back(number);
    for (const std::size_t k : partners) out.overlaps[k] = true;
  }
  // From large to small, so that the depth of every surrounding piece is known before.
  std::vector<std::size_t> by_size(out.pieces.size());
  for (std::size_t k = 0; k < by_size.size(); ++k) by_size[k] = k;
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t a, std::size_t b) { return out.pieces[a].area > out.pieces[b].area; });
  for (const std::size_t k : by_size) {
    for (const std::size_t outer : out.around[k])
      out.pieces[k].depth = std::max(out.pieces[k].depth, out.pieces[outer].depth + 1);
  }
  return out;
}

}  // namespace

double signed_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d& a = polygon[k];
    const Eigen::Vector2d& b = polygon[(k + 1) % polygon.size()];
    sum += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  return sum;
}

EvenOdd even_odd(const Polygon& polygon) {
  Outlines outlines = outlines_of(area_of(without_crossings(polygon)));
  // A loop that goes round the other way adds to the even-odd area and is taken from the signed one; a loop that goes
  // round a second time, the other way about.
  const double loops = 0.5 * std::abs(outlines.area_mm2 - std::abs(signed_area(polygon)));
  return {std::move(outlines.polygons), outlines.area_mm2, loops};
}

double common_area(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  return size_of(area_of(a) & area_of(b));
}

PlaneSection plane_section(const std::vector<Polygon>& contours) {
  PlaneSection out;
  if (contours.size() == 1) {
    out.polygons = contours;
    out.area_mm2 = std::abs(signed_area(contours.front()));
    out.parts = 1;
    return out;
  }
  const Arrangement arrangement = arrange(contours);
  out.twice = arrangement.twice;
  for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) {
    const Piece& piece = arrangement.pieces[k];
    const bool hole = piece.depth % 2 == 1;
    out.holes += hole ? 1 : 0;
    out.united += arrangement.overlaps[k] ? 1 : 0;
    if (!arrangement.exact) continue;
    out.parts += hole ? 0 : 1;
    out.area_mm2 += hole ? -piece.area : piece.area;
    out.polygons.push_back(*piece.polygon);
  }
  if (arrangement.exact) return out;
  Area whole;
  for (std::size_t k = 0; k < arrangement.pieces.size(); ++k) {
    const Piece& piece = arrangement.pieces[k];
    if (piece.depth % 2 == 1) continue;
    Area part = area_of(*piece.polygon);
    for (std::size_t hole = 0; hole < arrangement.pieces.size(); ++hole) {
      const auto& around = arrangement.around[hole];
      const bool in_part = std::find(around.begin(), around.end(), k) != around.end();
      if (in_part && arrangement.pieces[hole].depth == piece.depth + 1)
        part -= area_of(*arrangement.pieces[hole].polygon);
    }
    whole += part;
  }
  Outlines outlines = outlines_of(whole);
  out.polygons = std::move(outlines.polygons);
  out.area_mm2 = outlines.area_mm2;
  out.parts = outlines.parts;
  return out;
}

}  // namespace stylet::detail
