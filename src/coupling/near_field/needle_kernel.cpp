// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/needle_kernel.hpp"

#include "stylet/coupling/near_field/half_space.hpp"
#include "stylet/coupling/tip_dent.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

/// A Gauss–Legendre rule on [−½, ½].
struct Rule {
  int count;
  std::array<double, 4> point;
  std::array<double, 4> weight;
};
constexpr Rule kOne{1, {0.0}, {1.0}};
constexpr Rule kFour{4,
                     {-0.4305681557970263, -0.1699905217924282, 0.1699905217924282, 0.4305681557970263},
                     {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269}};

/// An image is smooth where its source is far away: beyond this many lengths of a piece, one point of the piece
/// suffices.
constexpr double kSmooth = 2.0;

/// ε of the tip deep inside a medium, in needle radii: the regularised force that moves the medium as far as the flat
/// end of a rod which slides in its hole without friction. By finite elements 0.87 at ν = 0.45 and 0.90 at ν = 0.49
/// (docs/theory/near_field.md §2). Raised, the tip is stiffer deep inside.
constexpr double kRodEnd = 0.88;

/// Distance from a border, in needle radii, within which ε changes to that of a tip on the border. Raised, the tip is
/// softer in front of harder tissue and behind softer tissue.
constexpr double kBorderReach = 1.5;

/// The dent under the tip falls with depth this many times less steeply than would make the tissue overtake the tip. At
/// 1 a cut would not unload the tip at all.
constexpr double kDentMargin = 1.5;

NearSurface moved(const NearSurface& skin, const Vec3& way) {
  NearSurface there = skin;
  there.depth = std::max(0.0, there.depth + there.inwards.dot(way));
  return there;
}

}  // namespace

double NeedleKernel::shaft_epsilon() const { return std::sqrt(std::numbers::e) * radius_mm; }

double NearBorder::weight(double epsilon) const {
  if (contrast == 0.0) return 0.0;
  const double way = 2.0 * depth / epsilon;
  return 1.0 / std::sqrt(1.0 + way * way);
}

namespace {

/// Relative change of the displacement of the loaded place by a border: far from the border the image of Mindlin's half
/// space, on the border once more the force's own field, both times the contrast.
struct BorderImage {
  double normal, tangential;

  BorderImage(const NearBorder& border, double epsilon, double nu) {
    const double own = 5.0 - 6.0 * nu;
    const auto image = [&](double strength) {
      const double there = strength / own * epsilon;
      return border.contrast * there / std::hypot(2.0 * border.depth, there);
    };
    normal = image(8.0 * (1.0 - nu) * (1.0 - nu) + 1.0);
    tangential = image(1.5 + 2.0 * (1.0 - nu) * (1.0 - 2.0 * nu));
  }
};

Mat3 along_and_across(const Vec3& n, double along, double across) {
  return across * Mat3::Identity() + (along - across) * n * n.transpose();
}

/// The stiffness with all borders over the stiffness without them. Harder tissue beyond a border adds the stiffness
/// that it would add alone. Softer tissue, and air, add their images to the displacement, so that the stiffness stays
/// positive.
Mat3 stiffness_with(std::span<const NearBorder> borders, double epsilon, double nu) {
  Mat3 softer = Mat3::Identity();
  Mat3 harder = Mat3::Zero();
  for (const NearBorder& border : borders) {
    if (border.contrast == 0.0 || !std::isfinite(border.depth)) continue;
    const BorderImage image(border, epsilon, nu);
    const auto added = [](double m) { return 1.0 / (1.0 + m) - 1.0; };
    if (border.contrast > 0.0) {
      softer += along_and_across(border.inwards, image.normal, image.tangential);
    } else {
      harder += along_and_across(border.inwards, added(image.normal), added(image.tangential));
    }
  }
  return softer.inverse() + harder;
}

std::array<NearBorder, 3> all_borders(const NearSurface& skin, const NearBorders& borders) {
  return {NearBorder{skin.depth, skin.inwards, skin.share}, borders[0], borders[1]};
}

}  // namespace

double NeedleKernel::tip_epsilon(const NearSurface& skin, double poisson) const {
  const double on_surface = (5.0 - 4.0 * poisson) / (2.0 * std::numbers::pi * (1.0 - poisson));
  return (kRodEnd + (on_surface - kRodEnd) * std::exp(-skin.depth / radius_mm)) * radius_mm;
}

double NeedleKernel::own_tip_epsilon(const NearSurface& skin, const NearBorders& borders, double poisson) const {
  // On a free surface the force and its image move it equally, together as far as a flat punch.
  const double on_border = (5.0 - 6.0 * poisson) / (2.0 * std::numbers::pi * (1.0 - poisson) * (1.0 - poisson));
  // The derivative is zero on the border, so that the tip's compliance does not rise as the tip goes in.
  const auto near = [&](double depth) { return std::exp(-std::pow(depth / (kBorderReach * radius_mm), 2)); };
  double felt = near(skin.depth);
  for (const NearBorder& border : borders) felt = std::max(felt, std::abs(border.contrast) * near(border.depth));
  return (kRodEnd + (on_border - kRodEnd) * felt) * radius_mm;
}

Mat3 tip_kernel(const NearSurface& skin, const NearBorders& borders, double epsilon, const Medium& medium) {
  const auto all = all_borders(skin, borders);
  return kelvinlet_self(medium) / epsilon * stiffness_with(all, epsilon, medium.poisson).inverse();
}

Mat3 with_borders(const Mat3& g, const NearSurface& skin, const NearBorders& borders, double epsilon, double poisson) {
  const auto all = all_borders(skin, borders);
  const Mat3 times =
      stiffness_with(all, epsilon, poisson).inverse() * stiffness_with(std::span(all).first(1), epsilon, poisson);
  const Mat3 both = times * g;
  return 0.5 * (both + both.transpose());
}

namespace {

double least_share_of(std::span<const NearBorder> borders, double epsilon, double poisson) {
  double softer = 1.0;
  double harder = 0.0;
  for (const NearBorder& border : borders) {
    if (border.contrast == 0.0 || !std::isfinite(border.depth)) continue;
    const BorderImage image(border, epsilon, poisson);
    if (border.contrast > 0.0) {
      softer += std::min(image.normal, image.tangential);
    } else {
      harder += 1.0 / (1.0 + std::min(image.normal, image.tangential)) - 1.0;
    }
  }
  return 1.0 / (1.0 / softer + harder);
}

}  // namespace

double least_share(const NearBorders& borders, double epsilon, double poisson) {
  return least_share_of(borders, epsilon, poisson);
}

double least_share_below(const NearSurface& skin, const NearBorders& borders, double epsilon, double poisson) {
  const auto all = all_borders(skin, borders);
  return least_share_of(all, epsilon, poisson) / least_share_of(std::span(all).first(1), epsilon, poisson);
}

Mat3 NeedleKernel::tip_self(const NearSurface& surface, const Medium& medium) const {
  return tip_kernel(surface, {}, own_tip_epsilon(surface, {}, medium.poisson), medium);
}

Mat3 NeedleKernel::dent(const NearSurface& surface, double press, const Medium& medium, double stiffening_MPa) const {
  if (press <= 0.0 || !std::isfinite(surface.depth)) return Mat3::Zero();
  const auto own = [&](double depth) {
    NearSurface there = surface;
    there.depth = depth;
    there.share = 1.0;
    return tip_self(there, medium);
  };
  const auto normal = [&](const Mat3& compliance) { return surface.inwards.dot(compliance * surface.inwards); };
  const Mat3 here = own(surface.depth);
  const Mat3 at_surface = own(0.0);
  const double fall = surface.depth / kDentMargin;
  double allowed = normal(at_surface) - fall / press;
  if (stiffening_MPa > 0.0) {
    const double left = DentLaw{normal(at_surface), stiffening_MPa}.depth(press) - fall;
    if (left <= 0.0) return Mat3::Zero();
    allowed = DentLaw::compliance_for(press, left, stiffening_MPa);
  }
  const double excess = allowed - normal(here);
  const double most = normal(at_surface) - normal(here);
  if (excess <= 0.0 || most <= 0.0) return Mat3::Zero();
  return std::min(1.0, excess / most) * (at_surface - here);
}

Mat3 point_kernel(const Vec3& r, const NearSurface& skin_at, const NearSurface& skin_on, double epsilon,
                  const Medium& medium) {
  Mat3 G = kelvinlet(r, epsilon, medium);
  if (skin_at.share + skin_on.share == 0.0) return G;
  return G + surface_image(r, skin_at, skin_on, epsilon, medium);
}

Mat3 needle_kernel(const Segment& at, const NearSurface& skin_at, const Segment& on, const NearSurface& skin_on,
                   double epsilon, const Medium& medium) {
  const Vec3 direction = at.length == 0.0   ? on.direction
                         : on.length == 0.0 ? at.direction
                                            : (at.direction + on.direction).normalized();
  Mat3 G = kelvinlet(at, on, direction, epsilon, medium);
  if (skin_at.share + skin_on.share == 0.0) return G;
  const bool smooth = skin_at.depth + skin_on.depth > kSmooth * std::max(at.length, on.length);
  const Rule& over_at = smooth || at.length == 0.0 ? kOne : kFour;
  const Rule& over_on = smooth || on.length == 0.0 ? kOne : kFour;
  for (int i = 0; i < over_at.count; ++i) {
    const Vec3 along_at = over_at.point[static_cast<std::size_t>(i)] * at.length * at.direction;
    const NearSurface here = moved(skin_at, along_at);
    for (int j = 0; j < over_on.count; ++j) {
      const Vec3 along_on = over_on.point[static_cast<std::size_t>(j)] * on.length * on.direction;
      const double weight = over_at.weight[static_cast<std::size_t>(i)] * over_on.weight[static_cast<std::size_t>(j)];
      G += weight *
           surface_image(at.centre + along_at - on.centre - along_on, here, moved(skin_on, along_on), epsilon, medium);
    }
  }
  return G;
}

}  // namespace stylet
