// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/tg43.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace stylet {

namespace {

/// [mm] Nearer to the axis than this the geometry function takes its limit on the axis, where β and sin θ vanish.
constexpr double kOnAxis_mm = 1e-6;
/// Steps of Simpson's rule over 0 … 180°, for φ_an from F: F is linear between its angles, and G_L is smooth.
constexpr int kSteps = 720;

/// Place of a value in an ascending table: between the entries i and i + 1, at this share of the way.
struct Place {
  std::size_t i = 0;
  double share = 0.0;  // 0 … 1
};

Place place_in(const std::vector<double>& table, double value) {
  if (table.size() == 1 || value <= table.front()) return {};
  if (value >= table.back()) return {table.size() - 2, 1.0};
  const auto above = std::upper_bound(table.begin(), table.end(), value);
  const auto i = static_cast<std::size_t>(above - table.begin()) - 1;
  return {i, (value - table[i]) / (table[i + 1] - table[i])};
}

double linear(const std::vector<double>& r, const std::vector<double>& values, double at) {
  const auto [i, share] = place_in(r, at);
  return r.size() == 1 ? values.front() : (1.0 - share) * values[i] + share * values[i + 1];
}

/// Angle [rad] under which a line source of length 2 half appears from a place along its axis and across it [mm].
double angle_of_source(double along, double across, double half) {
  return std::atan2(along + half, across) - std::atan2(along - half, across);
}

/// φ_an at one radius: the mean of the dose rate over all directions, divided by the dose rate at 90°. TG-43U1,
/// equation 9.
double mean_over_directions(const Tg43& tg43, double r) {
  const double length = tg43.source().active_length_mm;
  const auto part = [&](int k) {
    const double theta = std::numbers::pi * k / kSteps;
    const double across = k == 0 || k == kSteps ? 0.0 : r * std::sin(theta);
    // sin θ G_L, which is finite on the axis, too.
    const double geometry =
        length > 0.0 ? angle_of_source(r * std::cos(theta), across, 0.5 * length) / (length * r) : across / (r * r * r);
    return geometry * tg43.anisotropy(r, theta * 180.0 / std::numbers::pi);
  };
  double sum = 0.0;
  for (int k = 0; k < kSteps; k += 2) sum += part(k) + 4.0 * part(k + 1) + part(k + 2);
  const double integral = sum * std::numbers::pi / kSteps / 3.0;
  return integral / (2.0 * line_geometry(r, 0.0, length) * tg43.anisotropy(r, 90.0));
}

}  // namespace

const char* to_string(DoseFormalism formalism) {
  switch (formalism) {
    case DoseFormalism::line2d:
      return "line2d";
    case DoseFormalism::line1d:
      return "line1d";
    case DoseFormalism::point:
      return "point";
  }
  return "";
}

double line_geometry(double r, double cos_theta, double length) {
  if (length <= 0.0) return 1.0 / (r * r);
  const double along = r * cos_theta;
  const double across = r * std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  const double half = 0.5 * length;
  if (across < kOnAxis_mm && std::abs(along) > half) return 1.0 / (along * along - half * half);
  const double x = std::max(across, kOnAxis_mm);
  return angle_of_source(along, x, half) / (length * x);
}

Tg43::Tg43(SourceModel source, DoseFormalism formalism)
    : source_(std::move(source)),
      formalism_(formalism),
      log_g_(source_.isotope != "Ir-192"),
      at_reference_(line_geometry(kReference_mm, 0.0, source_.active_length_mm)) {
  // A source without a capsule gets one around its active part, so that its dose is finite, too.
  const bool has_capsule = source_.outer_length_mm > source_.active_length_mm;
  surface_.half_mm = has_capsule ? 0.5 * source_.outer_length_mm : 0.5 * source_.active_length_mm + kLeast_mm;
  surface_.radius_mm = source_.outer_diameter_mm > 0.0 ? 0.5 * source_.outer_diameter_mm : kLeast_mm;
  surface_.furthest_mm = std::hypot(surface_.half_mm, surface_.radius_mm);
  // g_P (r₀ / r)² = g_L G_L(r, 90°) / G_L(r₀, 90°): both describe the same doses on the transverse axis.
  for (std::size_t i = 0; i < source_.g.size(); ++i) {
    const double r = source_.g_r_mm[i];
    if (r < kLeast_mm) continue;
    const double squares = (r / kReference_mm) * (r / kReference_mm);
    g_point_r_mm_.push_back(r);
    g_point_.push_back(source_.g[i] * squares * line_geometry(r, 0.0, source_.active_length_mm) / at_reference_);
  }
  // A value that is missing is the one at the next larger radius, so fill in from the largest radius down.
  for (Eigen::Index i = 0; i < source_.F.rows(); ++i) {
    for (Eigen::Index j = source_.F.cols() - 2; j >= 0; --j) {
      if (std::isnan(source_.F(i, j))) source_.F(i, j) = source_.F(i, j + 1);
    }
  }
  if (!source_.phi.empty()) return;
  source_.phi_r_mm = source_.F_r_mm;
  for (double& r : source_.phi_r_mm) {
    r = std::max(r, kLeast_mm);
    source_.phi.push_back(mean_over_directions(*this, r));
  }
}

Result<Tg43> Tg43::create(SourceModel source, DoseFormalism formalism) {
  if (auto good = check_source(source, source.name.empty() ? "source" : "source " + source.name); !good)
    return good.error();
  return Tg43(std::move(source), formalism);
}

double Tg43::radial(double r) const { return radial_of(source_.g_r_mm, source_.g, r); }

double Tg43::radial_of(const std::vector<double>& radii, const std::vector<double>& g, double r) const {
  const std::size_t n = g.size();
  if (n == 1 || r <= radii.front()) return g.front();
  if (r > radii.back()) {
    const double slope = std::log(g[n - 1] / g[n - 2]) / (radii[n - 1] - radii[n - 2]);
    return g[n - 1] * std::exp(slope * (r - radii[n - 1]));
  }
  const auto [i, share] = place_in(radii, r);
  return log_g_ ? g[i] * std::pow(g[i + 1] / g[i], share) : (1.0 - share) * g[i] + share * g[i + 1];
}

double Tg43::anisotropy(double r, double theta_deg) const {
  if (theta_deg > 90.0 && source_.F_theta_deg.back() <= 90.0) theta_deg = 180.0 - theta_deg;
  const auto [j, across] = place_in(source_.F_r_mm, r);
  const auto [i, turn] = place_in(source_.F_theta_deg, theta_deg);
  const auto row = static_cast<Eigen::Index>(i);
  const auto column = static_cast<Eigen::Index>(j);
  const Eigen::Index next_row = std::min(row + 1, source_.F.rows() - 1);
  const Eigen::Index next_column = std::min(column + 1, source_.F.cols() - 1);
  const double here = (1.0 - across) * source_.F(row, column) + across * source_.F(row, next_column);
  const double there = (1.0 - across) * source_.F(next_row, column) + across * source_.F(next_row, next_column);
  return (1.0 - turn) * here + turn * there;
}

double Tg43::mean_anisotropy(double r) const { return linear(source_.phi_r_mm, source_.phi, r); }

double Tg43::radius_of_dose(double r, double cos_theta) const {
  if (formalism_ == DoseFormalism::line2d && r < surface_.furthest_mm) {
    const double along = r * std::abs(cos_theta);
    const double across = r * std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
    const double out = std::max(along / surface_.half_mm, across / surface_.radius_mm);  // 1 on the surface
    if (out < 1.0) r = out > 0.0 ? r / out : surface_.radius_mm;
  }
  return std::max(r, kLeast_mm);
}

double Tg43::rate(double r, double cos_theta) const {
  r = radius_of_dose(r, cos_theta);
  const double length = source_.active_length_mm;
  const auto line = [&](double cos_of_angle) {
    return source_.dose_rate_constant * radial(r) * line_geometry(r, cos_of_angle, length) / at_reference_;
  };
  switch (formalism_) {
    case DoseFormalism::line2d: {
      cos_theta = std::clamp(cos_theta, -1.0, 1.0);
      const double theta_deg = std::acos(cos_theta) * 180.0 / std::numbers::pi;
      return line(cos_theta) * anisotropy(r, theta_deg);
    }
    case DoseFormalism::line1d:
      return line(0.0) * mean_anisotropy(r);
    case DoseFormalism::point: {
      const double squares = (kReference_mm / r) * (kReference_mm / r);
      return source_.dose_rate_constant * squares * radial_of(g_point_r_mm_, g_point_, r) * mean_anisotropy(r);
    }
  }
  return 0.0;
}

double permanent_Gy_per_rate(double half_life_days) {
  constexpr double hours_per_day = 24.0;
  constexpr double Gy_per_cGy = 0.01;
  return half_life_days * hours_per_day / std::numbers::ln2 * Gy_per_cGy;
}

double mean_strength_while_decaying(double hours, double half_life_days) {
  constexpr double hours_per_day = 24.0;
  const double decays = std::numbers::ln2 * hours / (hours_per_day * half_life_days);  // λt
  return decays > 0.0 ? -std::expm1(-decays) / decays : 1.0;
}

void sum_rates(const Tg43& tg43, std::span<const PlacedSource> sources, std::span<const Vec3> points,
               std::span<double> rates) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    double sum = 0.0;
    for (const PlacedSource& source : sources) {
      const Vec3 to = points[p] - source.at_mm;
      const double r = to.norm();
      const double cos_theta = r > 0.0 ? to.dot(source.axis) / r : 0.0;
      sum += source.weight * tg43.rate(r, cos_theta);
    }
    rates[p] = sum;
  }
}

}  // namespace stylet
