// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/contour_plane.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace stylet::detail {

namespace {

constexpr double kOffPlane_mm = 0.1;   // distance of a contour's points from its plane; files round to 0.01 mm
constexpr double kMostTilt_deg = 1.0;  // largest angle between the planes of contours
constexpr double kLine_mm = 1e-3;      // a contour narrower than this is a line

/// Principal directions of a contour's points.
struct Principal {
  Vec3 normal;  ///< normal of the plane that fits the points best
  Vec3 width;   ///< direction in that plane, perpendicular to the longest one
};

Principal principal_of(const Contour& contour) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : contour.points) centre += p;
  centre /= static_cast<double>(contour.points.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : contour.points) scatter += (p - centre) * (p - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(scatter);
  return {principal.eigenvectors().col(0), principal.eigenvectors().col(1)};
}

/// Extent of the points along a unit direction [mm].
double extent_along(const Contour& contour, const Vec3& direction) {
  const auto [low, high] =
      std::minmax_element(contour.points.begin(), contour.points.end(),
                          [&](const Vec3& a, const Vec3& b) { return direction.dot(a) < direction.dot(b); });
  return direction.dot(*high - *low);
}

/// Lengths of a contour's sides [mm].
struct Sides {
  double closing = 0.0;  ///< from the last point to the first
  double other = 0.0;    ///< the longest of the other sides
};

Sides sides_of(const Contour& contour) {
  const auto& p = contour.points;
  Sides sides{.closing = (p.front() - p.back()).norm(), .other = 0.0};
  for (std::size_t k = 0; k + 1 < p.size(); ++k) sides.other = std::max(sides.other, (p[k + 1] - p[k]).norm());
  return sides;
}

}  // namespace

Vec3 area_vector(const Contour& contour) {
  Vec3 sum = Vec3::Zero();
  const auto& p = contour.points;
  for (std::size_t k = 1; k + 1 < p.size(); ++k) sum += 0.5 * (p[k] - p[0]).cross(p[k + 1] - p[0]);
  return sum;
}

ContourKind kind_of(const Contour& contour) {
  if (contour.points.size() < 3) return ContourKind::too_few_points;
  return extent_along(contour, principal_of(contour).width) < kLine_mm ? ContourKind::on_a_line : ContourKind::sound;
}

Vec3 fitted_normal(const Contour& contour) { return principal_of(contour).normal; }

Result<> check_plane(const Contour& contour, const Vec3& normal, const std::string& place) {
  const Vec3 own = fitted_normal(contour);
  const double off_plane = extent_along(contour, own);
  if (off_plane > kOffPlane_mm) {
    return input_error(place, fmt::format("its points are up to {:.3g} mm off a common plane", off_plane),
                       "Draw each contour within one slice");
  }
  const double tilt = std::acos(std::min(1.0, std::abs(own.dot(normal)))) * 180.0 / M_PI;
  if (extent_along(contour, normal) > kOffPlane_mm && tilt > kMostTilt_deg) {
    return input_error(place, fmt::format("its plane is tilted by {:.1f}° against the others", tilt),
                       "Draw all contours of a structure on parallel slices");
  }
  return Ok{};
}

}  // namespace stylet::detail

namespace stylet {

std::optional<std::string> long_closing_side(const Roi& roi) {
  std::size_t contours = 0;
  detail::Sides longest;
  for (const Contour& contour : roi.contours) {
    if (contour.points.size() < 8) continue;  // too few points to know their usual spacing
    const detail::Sides sides = detail::sides_of(contour);
    if (sides.closing <= std::max(5.0, 8.0 * sides.other)) continue;
    ++contours;
    if (sides.closing > longest.closing) longest = sides;
  }
  if (contours == 0) return std::nullopt;
  return fmt::format(
      "Structure '{}': in {} of {} contours the last point is far from the first, by up to {:.1f} mm, while other "
      "neighbouring points are at most {:.1f} mm apart. These contours are closed by a straight side.",
      roi.name, contours, roi.contours.size(), longest.closing, longest.other);
}

}  // namespace stylet
