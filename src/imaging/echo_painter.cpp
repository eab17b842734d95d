// SPDX-License-Identifier: GPL-3.0-or-later
#include "echo_painter.hpp"

#include "stylet/sim/imaging_settings.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// 0 below `from`, 1 above `to`, smooth in between.
double ramp(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// A smooth bump of the height 1 at x = middle, which ends at the distance `half`.
double bump(double x, double middle, double half) { return 1.0 - ramp(std::abs(x - middle), 0.0, half); }

/// Distance of p from the line a–b, and how far along it the nearest point is (0 … 1).
struct FromLine {
  double distance, along;
};
FromLine from_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double along = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return {(p - a - along * way).norm(), along};
}

}  // namespace

EchoPainter::EchoPainter(const Eigen::AlignedBox3d& gland, bool has_zones, bool has_vesicles, std::uint64_t seed)
    : gland_(gland),
      has_zones_(has_zones),
      has_vesicles_(has_vesicles),
      transition_dB_(default_echo("transition_zone").echo_dB - default_echo("prostate").echo_dB),
      vesicles_dB_(default_echo("seminal_vesicles").echo_dB),
      fine_(seed),
      coarse_(seed + 1),
      third_(seed + 2) {}

double EchoPainter::level_dB(TissueRole role, double own_dB, const EchoSpot& spot) const {
  const double texture = 1.3 * coarse_(spot.x / 6.0) + 1.0 * fine_(spot.x / 2.6) + 0.9 * third_(spot.x / 1.3);
  const double patches = 1.6 * coarse_(spot.x / 15.0 + Vec3::Constant(4.2));
  double level = own_dB;
  switch (role) {
    case TissueRole::gland:
      level += 0.7 * texture + gland_dB(spot);
      break;
    case TissueRole::zone:
      level += 0.7 * texture + capsule_dB(spot);
      break;
    case TissueRole::urethra:
      level += 0.7 * texture + urethra_dB(spot);
      break;
    case TissueRole::rectal_wall:
      level = wall_dB(spot) + 0.6 * texture;
      break;
    case TissueRole::fat:
      level = around_dB(level + 1.3 * texture + patches + fat_dB(spot), spot);
      break;
    case TissueRole::muscle:
    case TissueRole::soft:
      level = around_dB(level + 1.3 * texture + patches + muscle_dB(spot), spot);
      break;
    default:
      break;
  }
  return std::min(level, kSoft_dB);
}

Vec3 EchoPainter::relative(const Vec3& x) const { return (x - gland_.center()).cwiseQuotient(0.5 * gland_.sizes()); }

EchoPainter::Zone EchoPainter::zone(const EchoSpot& spot) const {
  const Vec3 q = relative(spot.x);
  const Vec3 from(q.x() / 0.66, (q.y() + 0.20) / 0.60, (q.z() - 0.10) / 0.78);
  const double f = from.norm() + 0.10 * coarse_(spot.x / 8.0) + 0.04 * fine_(spot.x / 3.5);
  return {q, f, ramp(q.y(), -0.35, 0.1), 1.0 - ramp(f, 0.94, 1.04)};
}

/// A bright line at the gland's surface.
double EchoPainter::capsule_dB(const EchoSpot& spot) { return 11.0 * bump(spot.gland_mm, 0.4, 1.1); }

/// Zones and their border, ducts, and the bright rim of the urethra.
double EchoPainter::gland_dB(const EchoSpot& spot) const {
  double level = capsule_dB(spot) + 4.0 * bump(spot.urethra_mm, -0.8, 1.2);
  if (has_zones_) return level;
  const Zone at = zone(spot);
  // Nodules of the transition zone are dark or bright, with bright rims.
  const double nodule = coarse_(spot.x / 5.0 + Vec3::Constant(7.3));
  const double rims = 5.0 * (1.0 - ramp(std::abs(nodule - 0.5), 0.05, 0.25));
  level += at.share * (transition_dB_ - 2.0 + 3.4 * nodule + rims);
  // Its border is a thin line of compressed tissue, clearest at the back.
  level += 13.0 * (0.25 + 0.75 * at.back) * bump(at.f, 1.0, 0.08);
  // The fibromuscular stroma in front is dark, ducts of the peripheral zone are streaks towards the urethra.
  level -= 7.0 * ramp(-at.q.y(), 0.5, 0.8) * (1.0 - ramp(std::abs(at.q.x()), 0.25, 0.5));
  const double angle = std::atan2(at.q.x(), at.q.y() + 0.3);
  level += (1.0 - at.share) * 1.4 * third_(Vec3(8.0 * angle, spot.x.z() / 1.5, 1.2 * at.q.head<2>().norm()));
  return level;
}

/// The lumen is a bright cleft in the middle of the dark wall.
double EchoPainter::urethra_dB(const EchoSpot& spot) const { return 7.0 * ramp(spot.urethra_mm, 1.4, 2.6); }

double EchoPainter::concretion_dB(TissueRole role, const EchoSpot& spot) const {
  if (role != TissueRole::gland || has_zones_) return kNone_dB;
  const Zone at = zone(spot);
  const double grain = third_(spot.x / 2.0 + Vec3::Constant(1.7));
  // Clusters of grains lie along the border of the transition zone.
  if (at.back > 0.3 && std::abs(at.f - 1.0) < 0.08 && spot.gland_mm > 2.5 &&
      coarse_(spot.x / 6.0 + Vec3::Constant(3.1)) > 0.35 && grain > 0.3)
    return 30.0;
  // They are common at the verumontanum, behind the urethra at the middle level.
  if (spot.urethra_mm > -2.0 && spot.urethra_mm < 0.0 && std::abs(at.q.x()) < 0.08 &&
      std::abs(at.q.z() + 0.05) < 0.08 && at.q.y() > 0.0 && grain > -0.2)
    return 30.0;
  return kNone_dB;
}

/// Interface and mucosa bright, muscularis mucosae dark, submucosa bright, muscularis propria dark, serosa bright.
double EchoPainter::wall_dB(const EchoSpot& spot) {
  const double from_lumen = std::max(0.0, -spot.lumen_mm), to_outside = std::max(0.0, spot.rectum_mm);
  const double across = from_lumen / std::max(1e-3, from_lumen + to_outside);
  double level = -22.0;
  level += 24.0 * bump(across, 0.0, 0.18);
  level += 25.0 * bump(across, 0.30, 0.19);
  level += 26.0 * ramp(across, 0.86, 0.97);
  return level;
}

/// Organs that the patient's structures seldom have, in place of the tissue around the gland.
double EchoPainter::around_dB(double level, const EchoSpot& spot) const {
  level -= 14.0 * bump(-spot.gland_mm, 1.5, 1.8);  // loose tissue beside the capsule
  // The wall of the bladder: 2.5 mm of muscle with a bright lining.
  const double wall = ramp(spot.bladder_mm, -3.0, -2.3) * (1.0 - ramp(spot.bladder_mm, 0.0, 0.2));
  level += wall * (-11.0 + 15.0 * bump(spot.bladder_mm, -0.4, 0.9) - level);
  if (has_vesicles_) return level;
  // A seminal vesicle on each side behind the bladder, above the base: a wound tube with bright walls; and beside the
  // middle the ampulla of the deferent duct.
  const Vec3 half = 0.5 * gland_.sizes();
  Vec3 p = spot.x - gland_.center();
  p.x() = std::abs(p.x());
  p += 1.1 * Vec3(fine_(spot.x / 6.0), coarse_(spot.x / 6.0 + Vec3::Constant(5.0)), third_(spot.x / 6.0));
  const FromLine vesicle = from_line(p, Vec3(0.24 * half.x(), 0.72 * half.y(), 1.00 * half.z()),
                                     Vec3(1.00 * half.x(), 0.90 * half.y(), 1.18 * half.z()));
  const FromLine duct = from_line(p, Vec3(0.10 * half.x(), 0.66 * half.y(), 0.98 * half.z()),
                                  Vec3(0.16 * half.x(), 0.95 * half.y(), 1.60 * half.z()));
  const double inside = 5.0 - 1.4 * vesicle.along - vesicle.distance;
  const double in_duct = 2.6 - duct.distance;
  const double depth = std::max(inside, in_duct);
  const double folds = 8.0 * (1.0 - ramp(std::abs(third_(spot.x / 3.2)), 0.05, 0.25));
  const double own = vesicles_dB_ - 7.0 + (inside > in_duct ? folds : 0.0);
  const double share = ramp(depth, -0.4, 0.4) * ramp(-spot.bladder_mm, 1.8, 2.6);
  return level + share * (own - level) + 5.0 * bump(depth, -0.6, 0.8);
}

/// Septa, the fascia and the veins around the gland.
double EchoPainter::fat_dB(const EchoSpot& spot) const {
  const double beside = -spot.gland_mm;
  const double septum = std::abs(coarse_(spot.x / 7.0) + 0.3 * fine_(spot.x / 3.0));
  double level = 6.0 * (1.0 - ramp(septum, 0.03, 0.16));
  const Vec3 q = relative(spot.x);
  const double where = bump(beside, 3.4, 3.4) * (1.0 - ramp(q.y(), 0.25, 0.7));
  const Vec3 along(spot.x.x() / 4.6, spot.x.y() / 3.8, spot.x.z() / 9.0);  // veins run along the gland
  level -= 40.0 * std::min(1.0, 1.4 * where) * ramp(third_(along), 0.0, 0.30);
  return level;
}

/// Bundles of fibres along z, with bright sheaths.
double EchoPainter::muscle_dB(const EchoSpot& spot) const {
  const Vec3 along(spot.x.x() / 2.6, spot.x.y() / 2.6, spot.x.z() / 14.0);
  return 2.4 * fine_(along) + 9.0 * (1.0 - ramp(std::abs(coarse_(spot.x / 11.0)), 0.02, 0.16));
}

}  // namespace stylet
