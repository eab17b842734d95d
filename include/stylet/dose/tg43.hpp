// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/source_model.hpp"

#include <span>

namespace stylet {

/// The three ways in which TG-43U1 computes the dose rate around a source.
enum class DoseFormalism {
  line2d,  ///< line source with the 2D anisotropy function F(r, θ); needs the direction of the source
  line1d,  ///< line source at θ = 90° with the 1D anisotropy function φ_an(r); no direction
  point    ///< point source with φ_an(r); no direction
};
const char* to_string(DoseFormalism formalism);  ///< "line2d", "line1d", "point"

/// Geometry function G_L [1/mm²] of a line source of length L at the distance r from its centre, at the angle θ to its
/// axis: β / (L r sin θ), where β is the angle under which the source appears; 1/r² for L = 0. TG-43U1, equation 4.
/// @param r [mm] > 0 @param cos_theta −1 … 1 @param length [mm] ≥ 0
[[nodiscard]] double line_geometry(double r, double cos_theta, double length);

/// Dose rate in water around one source by TG-43U1 (Rivard 2004, with the supplements of 2007 and 2017). Tables are
/// continued and interpolated as U1S1 recommends:
///   - g: logarithmically between its radii (Ir-192: linearly), constant below the first, exponentially through the
///   last
///     two beyond the last;
///   - F: linearly in r and θ, constant outside; angles beyond 90° are folded back where the table ends there; where a
///     value is missing the one at the next larger radius stands in;
///   - φ_an: linearly in r, constant outside; without a table it is computed from F and G_L;
///   - radii below kLeast_mm count as this radius;
///   - within the capsule (line2d) the dose is that at the capsule's surface in the same direction from the centre. In
///     the centre itself the dose rate is that beside it. The other formalisms have no direction and only kLeast_mm.
/// Immutable: any number of threads may use it.
class Tg43 {
 public:
  static constexpr double kLeast_mm = 0.5;       ///< least radius at which the tables are read
  static constexpr double kReference_mm = 10.0;  ///< r₀, where Λ holds and g = 1

  /// Errors: those of check_source().
  static Result<Tg43> create(SourceModel source, DoseFormalism formalism);

  /// Dose rate [cGy/(h U)] for each unit of air-kerma strength.
  /// @param r [mm] distance from the source's centre
  /// @param cos_theta cosine of the angle to the source's axis, −1 … 1; not used by line1d and point
  [[nodiscard]] double rate(double r, double cos_theta) const;

  /// Radial dose function g_L at r [mm].
  [[nodiscard]] double radial(double r) const;
  /// 2D anisotropy function F at r [mm] and the angle θ [°].
  [[nodiscard]] double anisotropy(double r, double theta_deg) const;
  /// 1D anisotropy function φ_an at r [mm].
  [[nodiscard]] double mean_anisotropy(double r) const;

  [[nodiscard]] const SourceModel& source() const { return source_; }
  [[nodiscard]] DoseFormalism formalism() const { return formalism_; }

 private:
  Tg43(SourceModel source, DoseFormalism formalism);
  /// The radius [mm] at which the dose of a place is computed: on the capsule's surface for places within it.
  [[nodiscard]] double radius_of_dose(double r, double cos_theta) const;
  [[nodiscard]] double radial_of(const std::vector<double>& radii, const std::vector<double>& g, double r) const;

  SourceModel source_;
  DoseFormalism formalism_;
  bool log_g_;                        ///< whether g is interpolated logarithmically
  std::vector<double> g_point_r_mm_;  ///< radii of g, from kLeast_mm on
  std::vector<double> g_point_;       ///< g_P at these radii
  double at_reference_;               ///< G_L(r₀, 90°)
  struct Surface {
    double half_mm = 0.0, radius_mm = 0.0;  ///< half of the length, radius
    double furthest_mm = 0.0;               ///< from the centre to the rim
  } surface_;                               ///< of the capsule
};

/// Dose [Gy] of a permanent implant, until the source has decayed, for each unit of dose rate at its start [cGy/h].
/// @param half_life_days [d]
[[nodiscard]] double permanent_Gy_per_rate(double half_life_days);

/// Mean strength of a source while it lies, divided by its strength at the beginning: (1 − e^(−λt)) / (λt).
/// @param hours t [h] ≥ 0 @param half_life_days ln 2 / λ [d]
[[nodiscard]] double mean_strength_while_decaying(double hours, double half_life_days);

/// A source at its place.
struct PlacedSource {
  Vec3 at_mm = Vec3::Zero();  ///< [mm] centre
  Vec3 axis = Vec3::UnitZ();  ///< unit vector along the source; its sign matters only for tables beyond 90°
  double weight = 1.0;        ///< factor on its dose rate: air-kerma strength [U], for HDR times the dwell time [h]
};

/// Sum of the dose rates of sources at points: [cGy/h] for weights in U, [cGy] for weights in U h.
/// @param rates (points.size()), overwritten
void sum_rates(const Tg43& tg43, std::span<const PlacedSource> sources, std::span<const Vec3> points,
               std::span<double> rates);

}  // namespace stylet
