// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.hpp"

#include <fmt/format.h>
#include "islands.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr double kKept = 100.0;     // [mm] margin around all other structures that is kept
constexpr double kWorthIt = 50.0;   // [mm] cropping must remove more than this beyond the margin
constexpr double kRounding = 15.0;  // [mm] radius of rounded edges

/// Keeps the largest piece and pieces that contain points of other structures.
double drop_limbs(GridShape& body, Anatomy& anatomy) {
  const Islands islands = find_islands(body);
  if (islands.volume.size() < 2) return 1;
  std::vector<bool> keep(islands.volume.size(), false);
  keep[std::max_element(islands.volume.begin(), islands.volume.end()) - islands.volume.begin()] = true;
  for (const Structure& s : anatomy.structures) {
    for (const Vec3& p : s.boundary) {
      const Vec3 g = (body.frame.local(p) - body.low).cwiseQuotient(body.spacing);
      std::array<int, 3> c{};
      for (int a = 0; a < 3; ++a) c[a] = std::clamp(static_cast<int>(std::lround(g[a])), 0, body.size[a] - 1);
      const int piece = islands.piece[body.at(c[0], c[1], c[2])];
      if (piece >= 0) keep[piece] = true;
    }
  }
  const double fraction = keep_islands(body, islands, keep);
  if (fraction < 1) {
    anatomy.notes.push_back(
        fmt::format("{:.1f} % of the body is left out, since it lies apart from the rest and contains no structure.",
                    100 * (1 - fraction)));
  }
  return fraction;
}

}  // namespace

double trim_body(GridShape& body, Anatomy& anatomy) {
  const double rounding = std::min(kRounding, 0.2 * body.inner_radius());
  Eigen::AlignedBox3d keep, all;  // in the slice frame
  for (const Structure& s : anatomy.structures) {
    for (const Vec3& p : s.boundary) keep.extend(body.frame.local(p));
  }
  for (int k = 0; k < body.size[2]; ++k) {
    for (int j = 0; j < body.size[1]; ++j) {
      for (int i = 0; i < body.size[0]; ++i) {
        if (body.values[body.at(i, j, k)] < 0) all.extend(body.low + body.spacing.cwiseProduct(Vec3(i, j, k)));
      }
    }
  }
  double fraction = 1;
  if (!keep.isEmpty()) {
    keep.min().array() -= kKept;
    keep.max().array() += kKept;
    bool crop = false;
    for (int c = 0; c < 3; ++c) {
      if (all.min()[c] > keep.min()[c] - kWorthIt) {
        keep.min()[c] = std::min(keep.min()[c], all.min()[c] - kWorthIt);
      } else {
        crop = true;
      }
      if (all.max()[c] < keep.max()[c] + kWorthIt) {
        keep.max()[c] = std::max(keep.max()[c], all.max()[c] + kWorthIt);
      } else {
        crop = true;
      }
    }
    if (crop) {
      const double before = body.volume(0);
      for (int k = 0; k < body.size[2]; ++k) {
        for (int j = 0; j < body.size[1]; ++j) {
          for (int i = 0; i < body.size[0]; ++i) {
            const Vec3 p = body.low + body.spacing.cwiseProduct(Vec3(i, j, k));
            float& v = body.values[body.at(i, j, k)];
            v = std::max(v, static_cast<float>((keep.min() - p).cwiseMax(p - keep.max()).maxCoeff()));
          }
        }
      }
      redistance(body);
      fraction = body.volume(0) / before;
      anatomy.notes.push_back(
          fmt::format("The body was cropped to {:.0f} mm around the other structures; {:.0f} % of it is meshed.", kKept,
                      100 * fraction));
    }
  }
  fraction *= drop_limbs(body, anatomy);
  round_edges(body, rounding);
  return fraction;
}

}  // namespace stylet::meshing
