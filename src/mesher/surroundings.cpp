// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr double kSkinBelowApex = 27.0;  // [mm] perineal skin to apex; 25–30 mm on transperineal ultrasound and MR
constexpr double kMargin = 25.0;         // [mm] margin of tissue around the anatomy
constexpr double kPaperMargin = 14.0;    // [mm] the same margin for MeshPreset::paper
constexpr double kBandRadius = 5.5;      // [mm]
constexpr double kBandLength = 20.0;     // [mm] length of the band between gland and pubic symphysis
constexpr double kBandReach = 40.0;      // [mm] a body surface within this distance is where the band ends

Eigen::AlignedBox3d box_of_all(const Anatomy& a) {
  Eigen::AlignedBox3d all;
  for (const Structure& s : a.structures) {
    if (s.name != "body") all.extend(s.shape->box());
  }
  return all;
}

/// Adds the smallest superquadric with the wanted margins as the body.
void add_body(Anatomy& a, bool small) {
  const Eigen::AlignedBox3d target = a.target_box();
  const Eigen::AlignedBox3d all = box_of_all(a);
  const double margin = small ? kPaperMargin : kMargin;
  const double skin = small ? kPaperMargin : kSkinBelowApex;
  // The full margins around the gland; around other structures just enough to cover them.
  Eigen::AlignedBox3d box(target.min() - Vec3(margin, margin, skin), target.max() + Vec3::Constant(margin));
  box.extend(Eigen::AlignedBox3d(all.min() - Vec3(10, 10, 8), all.max() + Vec3::Constant(10)));
  const Vec3 centre = box.center();
  Vec3 half = 0.5 * box.sizes();
  // Every structure must be at least 5 mm deep; the body is widened step by step until it is.
  for (int i = 0; i < 40; ++i) {
    const Superquadric body(centre, half);
    double shallow = -HUGE_VAL;
    for (const Structure& s : a.structures) {
      for (const Vec3& p : s.boundary) shallow = std::max(shallow, body.distance(p));
    }
    if (shallow < -5.0) break;
    half.head<2>() *= 1.03;
    half.z() *= 1.01;
  }
  Structure s;
  s.name = "body";
  s.generated = true;
  s.shape = std::make_shared<Superquadric>(centre, half);
  a.add(std::move(s));
  a.notes.push_back(fmt::format(
      "No body contour is used: a rounded body of {:.0f} x {:.0f} x {:.0f} mm was added, with the perineal skin "
      "{:.0f} mm inferior to the gland.",
      2 * half.x(), 2 * half.y(), 2 * half.z(), target.min().z() - (centre.z() - half.z())));
}

/// Adds a rod from inside the gland's anterior-inferior end towards the symphysis: anteriorly and slightly inferiorly.
void add_band(Anatomy& a) {
  const Eigen::AlignedBox3d target = a.target_box();
  const Vec3 direction = Vec3(0, -std::cos(0.35), -std::sin(0.35));
  // It starts on the anterior surface of the gland, in its middle, at about a quarter of its height.
  const double z = target.min().z() + 0.27 * target.sizes().z();
  Vec3 start = Vec3::Zero();
  double found = HUGE_VAL;
  const double mid = target.center().x();
  for (double x = mid - 8; x <= mid + 8; x += 2) {
    for (double y = target.min().y(); y < target.max().y(); y += 0.5) {
      const Vec3 p(x, y, z);
      if (a.target_distance(p) >= 0) continue;
      const double cost = y + 0.3 * std::abs(x - mid);
      if (cost < found) {
        found = cost;
        start = p;
      }
      break;
    }
  }
  if (found == HUGE_VAL) return;
  const Structure* body = a.find("body");
  double length = kBandLength;
  bool reaches = false;
  for (double t = 0; t <= kBandReach && !reaches; t += 0.5) {
    if (body->shape->distance(start + t * direction) > 0) {
      length = t + 2 * kBandRadius;  // the round end is outside, so the rod meets the boundary with its full section
      reaches = true;
    }
  }
  Structure s;
  s.name = "band";
  s.generated = true;
  s.shape = std::make_shared<Capsule>(start - 2.0 * direction, start + length * direction, kBandRadius);
  a.notes.push_back(
      fmt::format("No pubic arch contour is used: a stiff band of radius {:.1f} mm was added from the gland's "
                  "anterior-inferior end {}.",
                  kBandRadius, reaches ? "to the anterior boundary" : fmt::format("{:.0f} mm anteriorly", length)));
  // The band precedes the body and follows everything else; it is clipped to the body.
  Layer body_layer = std::move(a.layers.back());
  a.layers.pop_back();
  a.add(std::move(s));
  a.layers.back().clipped = true;
  a.layers.push_back(std::move(body_layer));
}

}  // namespace

void add_surroundings(Anatomy& a, const MeshOptions& options) {
  if (a.find("body") == nullptr) add_body(a, options.preset == MeshPreset::paper);
  if (options.stiff_band && a.find("pubic_arch") == nullptr && a.find("band") == nullptr) add_band(a);
  if (options.preset != MeshPreset::paper) add_soft_layers(a, options.layers);
}

}  // namespace stylet::meshing
