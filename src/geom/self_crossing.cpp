// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/self_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stylet::detail {

namespace {

using Vec2 = Eigen::Vector2d;

struct Edge {
  Vec2 a, b;
  Vec2 low, high;  // bounding box
};

double cross(const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); }

/// Whether p and q lie on different sides of the line through e, both farther from it than the tolerance.
bool separates(const Edge& e, const Vec2& p, const Vec2& q, double tolerance) {
  const Vec2 along = e.b - e.a;
  const double length = along.norm();
  if (length == 0.0) return false;
  const double dp = cross(along, p - e.a) / length;
  const double dq = cross(along, q - e.a) / length;
  return (dp > tolerance && dq < -tolerance) || (dp < -tolerance && dq > tolerance);
}

}  // namespace

std::optional<Crossing> find_self_crossing(const std::vector<Vec2>& points, double tolerance) {
  const std::size_t n = points.size();
  if (n < 4) return std::nullopt;
  std::vector<Edge> edges(n);
  Vec2 low = points[0], high = points[0];
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2& a = points[k];
    const Vec2& b = points[(k + 1) % n];
    edges[k] = {a, b, a.cwiseMin(b), a.cwiseMax(b)};
    low = low.cwiseMin(a);
    high = high.cwiseMax(a);
  }
  const int sweep = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
  const int other = 1 - sweep;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
    return std::pair(edges[p].low[sweep], p) < std::pair(edges[q].low[sweep], q);
  });
  std::vector<std::size_t> active;
  for (const std::size_t k : order) {
    const Edge& e = edges[k];
    std::erase_if(active, [&](std::size_t m) { return edges[m].high[sweep] < e.low[sweep]; });
    for (const std::size_t m : active) {
      const Edge& f = edges[m];
      if (f.high[other] < e.low[other] || f.low[other] > e.high[other]) continue;
      const std::size_t apart = k > m ? k - m : m - k;
      if (apart == 1 || apart == n - 1) continue;  // neighbouring edges share a point
      if (!separates(e, f.a, f.b, tolerance) || !separates(f, e.a, e.b, tolerance)) continue;
      const Vec2 u = e.b - e.a, v = f.b - f.a;
      const double t = cross(f.a - e.a, v) / cross(u, v);
      return Crossing{std::min(k, m), std::max(k, m), e.a + t * u};
    }
    active.push_back(k);
  }
  return std::nullopt;
}

}  // namespace stylet::detail
