// SPDX-License-Identifier: GPL-3.0-or-later
#include "shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet::meshing {
namespace {

/// In-plane signed distance of a slice's polygons (even-odd rule) at all pixels of a grid.
std::vector<float> polygon_distance(const StructureSlice& slice, const SliceFields& grid) {
  struct Edge {
    double ax, ay, dx, dy, inverse_length2;
  };
  std::vector<Edge> edges;
  for (const Polygon& p : slice.polygons) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Eigen::Vector2d a = p[i];
      const Eigen::Vector2d d = p[(i + 1) % p.size()] - a;
      if (d.squaredNorm() > 0) edges.push_back({a.x(), a.y(), d.x(), d.y(), 1 / d.squaredNorm()});
    }
  }
  std::vector<float> field(static_cast<std::size_t>(grid.size[0]) * grid.size[1]);
  for (int j = 0; j < grid.size[1]; ++j) {
    const double y = grid.low.y() + j * grid.spacing.y();
    for (int i = 0; i < grid.size[0]; ++i) {
      const double x = grid.low.x() + i * grid.spacing.x();
      double best = HUGE_VAL;
      bool inside = false;
      for (const Edge& e : edges) {
        const double px = x - e.ax, py = y - e.ay;
        const double t = std::clamp((px * e.dx + py * e.dy) * e.inverse_length2, 0.0, 1.0);
        const double qx = px - t * e.dx, qy = py - t * e.dy;
        best = std::min(best, qx * qx + qy * qy);
        if ((py < 0) != (py - e.dy < 0) && px < e.dx * py / e.dy) inside = !inside;
      }
      const double d = std::sqrt(best);
      field[static_cast<std::size_t>(j) * grid.size[0] + i] = static_cast<float>(inside ? -d : d);
    }
  }
  return field;
}

/// Lower envelope of parabolas: d[i] = min_j f[j] + (h (i − j))².
void envelope(const std::vector<double>& f, double h, std::vector<double>& d) {
  const int n = static_cast<int>(f.size());
  std::vector<int> v(n);
  std::vector<double> z(n + 1);
  int k = -1;
  const double h2 = h * h;
  for (int q = 0; q < n; ++q) {
    if (f[q] == HUGE_VAL) continue;
    double s = -HUGE_VAL;
    while (k >= 0) {
      s = ((f[q] + h2 * q * q) - (f[v[k]] + h2 * v[k] * v[k])) / (2 * h2 * (q - v[k]));
      if (s > z[k]) break;
      --k;
    }
    ++k;
    v[k] = q;
    z[k] = k == 0 ? -HUGE_VAL : s;
    z[k + 1] = HUGE_VAL;
  }
  if (k < 0) return;
  const int last = k;
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (k < last && z[k + 1] < q) ++k;
    d[q] = f[v[k]] + h2 * (q - v[k]) * (q - v[k]);
  }
}

/// Squared distance [mm²] of every pixel to the nearest pixel where `mask` has the value `to`.
std::vector<double> squared_distance(const std::vector<bool>& mask, bool to, int nx, int ny, double dx, double dy) {
  std::vector<double> d(mask.size(), HUGE_VAL);
  for (std::size_t n = 0; n < mask.size(); ++n) {
    if (mask[n] == to) d[n] = 0;
  }
  std::vector<double> line, out;
  for (int i = 0; i < nx; ++i) {
    line.assign(ny, 0);
    for (int j = 0; j < ny; ++j) line[j] = d[static_cast<std::size_t>(j) * nx + i];
    out.assign(ny, HUGE_VAL);
    envelope(line, dy, out);
    for (int j = 0; j < ny; ++j) d[static_cast<std::size_t>(j) * nx + i] = out[j];
  }
  for (int j = 0; j < ny; ++j) {
    line.assign(d.begin() + static_cast<std::ptrdiff_t>(j) * nx, d.begin() + static_cast<std::ptrdiff_t>(j + 1) * nx);
    out.assign(nx, HUGE_VAL);
    envelope(line, dx, out);
    std::copy(out.begin(), out.end(), d.begin() + static_cast<std::ptrdiff_t>(j) * nx);
  }
  return d;
}

/// Weights of a cubic Hermite curve through slice values. Slopes follow from the neighbours (Catmull–Rom) and are
/// one-sided at the ends of a run of slices.
struct HermiteWeights {
  std::array<int, 4> slice{};
  std::array<double, 4> weight{};
};

HermiteWeights hermite(const std::vector<double>& h, int first, int last, int i, double w) {
  HermiteWeights r;
  const double d = h[i + 1] - h[i];
  const double t = (w - h[i]) / d;
  const double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t);
  const double h01 = t * t * (3 - 2 * t), h11 = t * t * (t - 1);
  const int before = i > first ? i - 1 : i;
  const int after = i + 1 < last ? i + 2 : i + 1;
  r.slice = {before, i, i + 1, after};
  r.weight = {0, h00, h01, 0};
  const double m0 = h10 * d / (h[i + 1] - h[before]);
  const double m1 = h11 * d / (h[after] - h[i]);
  r.weight[2] += m0;
  r.weight[before == i ? 1 : 0] -= m0;
  r.weight[after == i + 1 ? 2 : 3] += m1;
  r.weight[1] -= m1;
  return r;
}

}  // namespace

std::vector<float> mask_distance(const std::vector<bool>& mask, int nx, int ny, double dx, double dy) {
  if (std::find(mask.begin(), mask.end(), true) == mask.end()) return {};
  const std::vector<double> to_in = squared_distance(mask, true, nx, ny, dx, dy);
  const std::vector<double> to_out = squared_distance(mask, false, nx, ny, dx, dy);
  const double half = 0.25 * (dx + dy);  // the border is half a pixel away from the pixel centres on either side
  std::vector<float> d(mask.size());
  for (std::size_t n = 0; n < mask.size(); ++n) {
    d[n] = static_cast<float>(mask[n] ? half - std::sqrt(to_out[n]) : std::sqrt(to_in[n]) - half);
  }
  return d;
}

std::shared_ptr<GridShape> interpolate_fields(const SliceFields& stack, double step, double sigma) {
  // Runs of consecutive slices with the structure; caps close each run.
  struct Run {
    int first, last;
    double first_radius, last_radius;  // largest inner distance in the end slices
  };
  const double cap = 0.5 * stack.gap;
  std::vector<Run> runs;
  const int slices = static_cast<int>(stack.heights.size());
  const auto radius = [&](int s) {
    return std::max(1e-3, -static_cast<double>(*std::min_element(stack.fields[s].begin(), stack.fields[s].end())));
  };
  for (int s = 0; s < slices; ++s) {
    if (stack.fields[s].empty()) continue;
    const bool joins = !runs.empty() && runs.back().last == s - 1 && stack.joins_next[s - 1];
    if (joins) {
      runs.back().last = s;
    } else {
      runs.push_back({s, s, 0, 0});
    }
  }
  if (runs.empty()) return nullptr;
  for (Run& r : runs) {
    r.first_radius = radius(r.first);
    r.last_radius = radius(r.last);
  }
  auto g = std::make_shared<GridShape>();
  g->frame = stack.frame;
  const double margin = cap + 4 * step;
  const double bottom = stack.heights[runs.front().first] - margin;
  const double top = stack.heights[runs.back().last] + margin;
  const int nk = std::max(4, static_cast<int>(std::ceil((top - bottom) / step)) + 1);
  g->low = Vec3(stack.low.x(), stack.low.y(), bottom);
  g->spacing = Vec3(stack.spacing.x(), stack.spacing.y(), (top - bottom) / (nk - 1));
  g->size = {stack.size[0], stack.size[1], nk};
  const std::size_t plane = static_cast<std::size_t>(stack.size[0]) * stack.size[1];
  g->values.assign(plane * nk, std::numeric_limits<float>::max());
  for (int k = 0; k < nk; ++k) {
    const double w = bottom + k * g->spacing.z();
    float* out = g->values.data() + plane * k;
    for (const Run& r : runs) {
      const double low = stack.heights[r.first], high = stack.heights[r.last];
      if (w <= low || w >= high || r.first == r.last) {
        // Cap: an ellipse from the contour to half a slice beyond it. Further out the distance keeps growing.
        const bool below = w <= low;
        const auto& d = stack.fields[below ? r.first : r.last];
        const double depth = below ? low - w : std::max(0.0, w - high);
        const double t = std::min(1.0, depth / cap);
        const double end_radius = below ? r.first_radius : r.last_radius;
        const double add = end_radius * (1 - std::sqrt(1 - t * t)) + std::max(0.0, depth - cap);
        for (std::size_t n = 0; n < plane; ++n) out[n] = std::min(out[n], static_cast<float>(d[n] + add));
      } else {
        int i = r.first;
        while (i + 1 < r.last && stack.heights[i + 1] < w) ++i;
        const HermiteWeights hw = hermite(stack.heights, r.first, r.last, i, w);
        for (std::size_t n = 0; n < plane; ++n) {
          double v = 0;
          for (int q = 0; q < 4; ++q) v += hw.weight[q] * stack.fields[hw.slice[q]][n];
          out[n] = std::min(out[n], static_cast<float>(v));
        }
      }
    }
  }
  redistance(*g);
  if (sigma > 0) {
    smooth(*g, sigma);
    redistance(*g);
  }
  return g;
}

std::shared_ptr<GridShape> interpolate_slices(const StructureSlices& slices, double voxel, double sigma) {
  SliceFields stack;
  stack.frame = slices.frame;
  stack.gap = slices.usual_gap_mm;
  Eigen::AlignedBox2d box;
  for (const StructureSlice& s : slices.slices) {
    for (const Polygon& p : s.polygons) {
      for (const auto& q : p) box.extend(q);
    }
  }
  const double margin = 4 * voxel;
  box.min().array() -= margin;
  box.max().array() += margin;
  for (int a = 0; a < 2; ++a) {
    stack.size[a] = std::max(4, static_cast<int>(std::ceil(box.sizes()[a] / voxel)) + 1);
    stack.spacing[a] = box.sizes()[a] / (stack.size[a] - 1);
  }
  stack.low = box.min();
  for (const StructureSlice& s : slices.slices) {
    stack.heights.push_back(s.height);
    stack.joins_next.push_back(s.joins_next);
    stack.fields.push_back(polygon_distance(s, stack));
  }
  return interpolate_fields(stack, voxel, sigma);
}

}  // namespace stylet::meshing
