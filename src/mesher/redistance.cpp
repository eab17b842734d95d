// SPDX-License-Identifier: GPL-3.0-or-later
#include "shape.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr float kFar = 1e6F;

/// Distance of every node next to the zero surface, from the points where the surface cuts the grid lines through the
/// node. The cuts along the three axes span a plane whose distance d satisfies 1/d² = Σ 1/cut². Other nodes get kFar.
std::vector<float> distance_beside_surface(const GridShape& g) {
  std::vector<float> d(g.values.size(), kFar);
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(g.size[0]),
                                          static_cast<std::size_t>(g.size[0]) * g.size[1]};
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const std::array<int, 3> c{i, j, k};
        const std::size_t n = g.at(i, j, k);
        const double v = g.values[n];
        double inverse2 = 0;
        for (int a = 0; a < 3; ++a) {
          double cut = HUGE_VAL;
          for (const int step : {-1, 1}) {
            if (c[a] + step < 0 || c[a] + step >= g.size[a]) continue;
            const double w = g.values[step > 0 ? n + stride[a] : n - stride[a]];
            if ((v < 0) == (w < 0)) continue;
            cut = std::min(cut, v / (v - w) * g.spacing[a]);
          }
          if (cut < HUGE_VAL) inverse2 += 1 / std::max(cut * cut, 1e-12);
        }
        if (inverse2 > 0) d[n] = static_cast<float>(1 / std::sqrt(inverse2));
      }
    }
  }
  return d;
}

/// The terms of the eikonal equation along one axis of the grid.
struct Along {
  double a;       ///< [mm] smallest distance of the two neighbours
  double h;       ///< [mm] grid spacing
  double weight;  ///< [1/mm²] 1/h²
};

/// Solves Σ max(0, (t − a_i)/h_i)² = 1 for t (upwind discretisation of the eikonal equation) over three axes.
double eikonal(Along x, Along y, Along z) {
  const auto order = [](Along& first, Along& second) {
    if (first.a > second.a) std::swap(first, second);
  };
  order(x, y);
  order(y, z);
  order(x, y);
  double t = x.a + x.h;
  if (!(t > y.a)) return t;
  // p t² − 2 q t + r = 0
  double p = x.weight + y.weight;
  double q = x.weight * x.a + y.weight * y.a;
  double r = -1 + x.weight * x.a * x.a + y.weight * y.a * y.a;
  double root = q * q - p * r;
  if (root < 0) return t;
  t = (q + std::sqrt(root)) / p;
  if (!(t > z.a)) return t;
  p += z.weight;
  q += z.weight * z.a;
  r += z.weight * z.a * z.a;
  root = q * q - p * r;
  return root < 0 ? t : (q + std::sqrt(root)) / p;
}

}  // namespace

void redistance(GridShape& g) {
  std::vector<float> d = distance_beside_surface(g);
  const std::vector<float> fixed = d;
  const Vec3 weight = g.spacing.cwiseProduct(g.spacing).cwiseInverse();
  const auto near = [&](std::size_t n, std::size_t stride, int c, int last) {
    return static_cast<double>(std::min(c > 0 ? d[n - stride] : kFar, c < last ? d[n + stride] : kFar));
  };
  const std::size_t dj = g.size[0];
  const std::size_t dk = dj * g.size[1];
  // A node is processed again only if a neighbour's distance has become smaller since. Most nodes are final after one
  // or two sweeps. @cite S. Bak, J. McLaughlin, D. Renzi, "Some improvements for the fast sweeping method", SIAM J Sci
  // Comput 32 (2010) 2853–2874
  std::vector<char> stale(d.size(), 1);
  // Each of the eight directions once, which suffices for straight characteristics.
  for (int sweep = 0; sweep < 8; ++sweep) {
    const bool ri = (sweep & 1) != 0, rj = (sweep & 2) != 0, rk = (sweep & 4) != 0;
    for (int kk = 0; kk < g.size[2]; ++kk) {
      const int k = rk ? g.size[2] - 1 - kk : kk;
      for (int jj = 0; jj < g.size[1]; ++jj) {
        const int j = rj ? g.size[1] - 1 - jj : jj;
        for (int ii = 0; ii < g.size[0]; ++ii) {
          const int i = ri ? g.size[0] - 1 - ii : ii;
          const std::size_t n = g.at(i, j, k);
          if (stale[n] == 0 || fixed[n] < kFar) continue;
          stale[n] = 0;
          const Along x{near(n, 1, i, g.size[0] - 1), g.spacing[0], weight[0]};
          const Along y{near(n, dj, j, g.size[1] - 1), g.spacing[1], weight[1]};
          const Along z{near(n, dk, k, g.size[2] - 1), g.spacing[2], weight[2]};
          if (std::min({x.a, y.a, z.a}) >= d[n]) continue;
          const auto t = static_cast<float>(eikonal(x, y, z));
          if (t >= d[n]) continue;
          d[n] = t;
          const auto mark = [&](std::size_t stride, int c, int last) {
            if (c > 0) stale[n - stride] = 1;
            if (c < last) stale[n + stride] = 1;
          };
          mark(1, i, g.size[0] - 1);
          mark(dj, j, g.size[1] - 1);
          mark(dk, k, g.size[2] - 1);
        }
      }
    }
  }
  for (std::size_t n = 0; n < d.size(); ++n) g.values[n] = g.values[n] < 0 ? -d[n] : d[n];
}

void smooth(GridShape& g, double sigma) {
  if (!(sigma > 0)) return;
  for (int a = 0; a < 3; ++a) {
    const double s = sigma / g.spacing[a];
    const int reach = static_cast<int>(std::ceil(3 * s));
    if (s < 0.2) continue;
    std::vector<double> w(reach + 1);
    double sum = 0;
    for (int i = 0; i <= reach; ++i) {
      w[i] = std::exp(-0.5 * i * i / (s * s));
      sum += i == 0 ? w[i] : 2 * w[i];
    }
    for (double& x : w) x /= sum;
    const std::size_t stride = a == 0 ? 1 : a == 1 ? g.size[0] : static_cast<std::size_t>(g.size[0]) * g.size[1];
    const int n = g.size[a];
    std::vector<float> line(n);
    const std::size_t lines = g.values.size() / n;
    for (std::size_t l = 0; l < lines; ++l) {
      const std::size_t start = l / stride * stride * n + l % stride;
      for (int i = 0; i < n; ++i) line[i] = g.values[start + i * stride];
      for (int i = 0; i < n; ++i) {
        double v = w[0] * line[i];
        for (int r = 1; r <= reach; ++r) v += w[r] * (line[std::max(0, i - r)] + line[std::min(n - 1, i + r)]);
        g.values[start + i * stride] = static_cast<float>(v);
      }
    }
  }
}

void round_edges(GridShape& g, double radius) {
  if (!(radius > 0)) return;
  for (float& v : g.values) v += static_cast<float>(radius);
  redistance(g);
  for (float& v : g.values) v -= static_cast<float>(radius);
  redistance(g);
}

std::shared_ptr<GridShape> unite(const GridShape& a, const GridShape& b) {
  auto u = std::make_shared<GridShape>();
  u->frame = a.frame;
  const auto top = [](const GridShape& g) {
    return Vec3(g.low + g.spacing.cwiseProduct(Vec3(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1)));
  };
  u->low = a.low.cwiseMin(b.low);
  const Vec3 extent = top(a).cwiseMax(top(b)) - u->low;
  for (int c = 0; c < 3; ++c) {
    u->size[c] = static_cast<int>(std::ceil(extent[c] / std::min(a.spacing[c], b.spacing[c]))) + 1;
    u->spacing[c] = extent[c] / (u->size[c] - 1);
  }
  u->values.resize(static_cast<std::size_t>(u->size[0]) * u->size[1] * u->size[2]);
  std::size_t n = 0;
  for (int k = 0; k < u->size[2]; ++k) {
    for (int j = 0; j < u->size[1]; ++j) {
      for (int i = 0; i < u->size[0]; ++i) {
        const Vec3 p = u->node(i, j, k);
        u->values[n++] = static_cast<float>(std::min(a.distance(p), b.distance(p)));
      }
    }
  }
  redistance(*u);
  return u;
}

}  // namespace stylet::meshing
