// SPDX-License-Identifier: GPL-3.0-or-later
#include "contours/self_crossing.hpp"
#include "stylet/geom/structure_names.hpp"
#include "stylet/io/contours_io.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr double plane_tolerance_mm = 0.1;      // distance of a slice's points from its plane; files round to 0.01 mm
constexpr double same_slice_mm = 0.05;          // contours nearer to each other than this lie on one slice
constexpr double max_tilt_deg = 1.0;            // largest angle between the planes of contours
constexpr double crossing_tolerance_mm = 0.05;  // smaller overlaps of edges are rounding errors
constexpr double min_width_mm = 1e-3;           // a contour narrower than this is a line

/// Vector area of a closed polygon: its length is the area, its direction the normal (Newell).
Vec3 vector_area(const Contour& contour) {
  Vec3 area = Vec3::Zero();
  const auto& p = contour.points;
  for (std::size_t i = 0; i < p.size(); ++i) area += (p[i] - p[0]).cross(p[(i + 1) % p.size()] - p[0]);
  return 0.5 * area;
}

/// Principal directions of a contour's points.
struct Frame {
  Vec3 normal;  ///< normal of the plane that fits the points best
  Vec3 width;   ///< direction in that plane, perpendicular to the longest one
};

Frame fitted_frame(const Contour& contour) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : contour.points) centre += p;
  centre /= static_cast<double>(contour.points.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : contour.points) scatter += (p - centre) * (p - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(scatter);
  return {principal.eigenvectors().col(0), principal.eigenvectors().col(1)};
}

/// Extent of the points along a unit direction.
double thickness(const Contour& contour, const Vec3& normal) {
  const auto [low, high] =
      std::minmax_element(contour.points.begin(), contour.points.end(),
                          [&](const Vec3& a, const Vec3& b) { return normal.dot(a) < normal.dot(b); });
  return normal.dot(*high - *low);
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

class RoiCheck {
 public:
  RoiCheck(const Roi& roi, const std::string& where)
      : roi_(roi), where_(fmt::format("{}, ROI '{}'", where, roi.name)) {}

  Result<> run() {
    if (roi_.contours.empty())
      return input_error(where_, "the structure is empty", "Contour it, or choose another structure");
    for (std::size_t i = 0; i < roi_.contours.size(); ++i) {
      if (Result<> r = check_points(i); !r) return r;
    }
    if (Result<> r = check_extent(); !r) return r;
    const auto biggest = std::max_element(
        roi_.contours.begin(), roi_.contours.end(),
        [](const Contour& a, const Contour& b) { return vector_area(a).norm() < vector_area(b).norm(); });
    normal_ = fitted_frame(*biggest).normal;
    for (std::size_t i = 0; i < roi_.contours.size(); ++i) {
      if (Result<> r = check_plane(i); !r) return r;
      if (Result<> r = check_simple(i); !r) return r;
    }
    return check_slices();
  }

 private:
  [[nodiscard]] std::string place(std::size_t i) const {
    const Vec3& p = roi_.contours[i].points.front();
    return fmt::format("{}, contour {} (slice z = {:.2f} mm)", where_, i + 1, p.z());
  }

  Result<> check_points(std::size_t i) const {
    const Contour& contour = roi_.contours[i];
    if (contour.points.size() < 3) {
      return input_error(fmt::format("{}, contour {}", where_, i + 1),
                         fmt::format("{} point{}, at least 3 are needed", contour.points.size(),
                                     contour.points.size() == 1 ? "" : "s"),
                         "Delete or redraw this contour");
    }
    for (std::size_t k = 0; k < contour.points.size(); ++k) {
      const Vec3& p = contour.points[k];
      if (!p.allFinite()) {
        return input_error(fmt::format("{}, contour {}, point {}", where_, i + 1, k + 1),
                           fmt::format("the coordinates ({}, {}, {}) are not finite", p.x(), p.y(), p.z()),
                           "Redraw this contour");
      }
    }
    return Ok{};
  }

  Result<> check_extent() const {
    Eigen::AlignedBox3d box;
    for (const Contour& contour : roi_.contours) {
      for (const Vec3& p : contour.points) box.extend(p);
    }
    const double extent = box.sizes().maxCoeff();
    if (extent >= 1.0 && extent <= 2000.0) return Ok{};
    return input_error(where_, fmt::format("the structure is {:.4g} mm long, 1 mm to 2 m is expected", extent),
                       extent < 1.0 ? "Convert the coordinates to mm; they are probably in metres"
                                    : "Convert the coordinates to mm; they are probably in micrometres");
  }

  Result<> check_plane(std::size_t i) const {
    const Contour& contour = roi_.contours[i];
    const Frame own = fitted_frame(contour);
    if (thickness(contour, own.width) < min_width_mm) {
      return input_error(place(i), "its points coincide or lie on a line; it encloses nothing",
                         "Delete or redraw this contour");
    }
    const double off_plane = thickness(contour, own.normal);
    if (off_plane > plane_tolerance_mm) {
      return input_error(place(i), fmt::format("its points are up to {:.3g} mm off a common plane", off_plane),
                         "Draw each contour within one slice");
    }
    const double tilt = std::acos(std::min(1.0, std::abs(own.normal.dot(normal_)))) * 180.0 / M_PI;
    if (thickness(contour, normal_) > plane_tolerance_mm && tilt > max_tilt_deg) {
      return input_error(place(i), fmt::format("its plane is tilted by {:.1f}° against the others", tilt),
                         "Draw all contours of a structure on parallel slices");
    }
    return Ok{};
  }

  Result<> check_simple(std::size_t i) const {
    const Contour& contour = roi_.contours[i];
    const Vec3 u = normal_.unitOrthogonal();
    const Vec3 v = normal_.cross(u);
    std::vector<Eigen::Vector2d> points;
    points.reserve(contour.points.size());
    for (const Vec3& p : contour.points) points.emplace_back(u.dot(p), v.dot(p));
    const auto crossing = detail::find_self_crossing(points, crossing_tolerance_mm);
    if (!crossing) return Ok{};
    const Vec3 at = crossing->point.x() * u + crossing->point.y() * v + normal_.dot(contour.points.front()) * normal_;
    return input_error(place(i),
                       fmt::format("it crosses itself at ({:.2f}, {:.2f}, {:.2f}) mm, after its points {} and {}",
                                   at.x(), at.y(), at.z(), crossing->first_edge + 1, crossing->second_edge + 1),
                       "Redraw this contour without the loop");
  }

  Result<> check_slices() const {
    const double first = normal_.dot(roi_.contours.front().points.front());
    for (const Contour& contour : roi_.contours) {
      if (std::abs(normal_.dot(contour.points.front()) - first) > same_slice_mm) return Ok{};
    }
    return input_error(
        where_,
        fmt::format("the structure has contours on one slice only (z = {:.2f} mm), at least 2 are needed",
                    roi_.contours.front().points.front().z()),
        "Contour it on every slice it reaches, or choose another structure");
  }

  const Roi& roi_;
  std::string where_;
  Vec3 normal_ = Vec3::UnitZ();
};

}  // namespace

Result<> check_roi(const Roi& roi, const std::string& where) {
  Result<> sound = RoiCheck(roi, where).run();
  if (sound) return sound;
  Error error = sound.error();
  error.cure += or_skip(roi.name);
  return error;
}

std::optional<std::string> long_closing_side(const Roi& roi) {
  std::size_t contours = 0;
  Sides longest;
  for (const Contour& contour : roi.contours) {
    if (contour.points.size() < 8) continue;  // too few points to know their usual spacing
    const Sides sides = sides_of(contour);
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
