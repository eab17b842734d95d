// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/tg43.hpp"

#include <span>
#include <vector>

namespace stylet {

/// A part of the time in which all distances are longer by the same factor: swelling that is the same in all
/// directions.
struct Stretch {
  double share = 1.0;   ///< weight of this part; those of all parts sum to 1
  double factor = 1.0;  ///< > 0, on the distances
};

/// The dose rate around a source as a table, for many points: some ten times faster than Tg43::rate(). The table holds
/// r² times the dose rate, on equal steps of the radius and of the angle, and is read linearly between them; nearer
/// than kNear_mm and beyond the table the formula itself is used. The difference from the formula is below 0.05 % (test
/// RateTable.*). Where the tissue swells alike in all directions, the table holds the mean rate over the parts of the
/// time, at the distances without swelling. Immutable: any number of threads may use it.
class RateTable {
 public:
  static constexpr double kNear_mm = 4.0;   ///< nearer than this the formula is used
  static constexpr double kFar_mm = 200.0;  ///< and beyond this

  /// @param stretches parts of the time; at least one
  explicit RateTable(Tg43 tg43, std::vector<Stretch> stretches = {Stretch{}});

  /// Dose rate as Tg43::rate() [cGy/(h U)], its mean over the stretches.
  /// @param r [mm] @param cos_theta −1 … 1
  [[nodiscard]] double rate(double r, double cos_theta) const;

  /// Adds the dose rates of one source to those of points: [cGy/h] for a weight in U.
  /// @param rates (points.size()); the rates of the source are added to them
  void add(const PlacedSource& source, std::span<const Vec3> points, std::span<double> rates) const;

  [[nodiscard]] const Tg43& tg43() const { return tg43_; }

 private:
  [[nodiscard]] double formula(double r, double cos_theta) const;

  Tg43 tg43_;
  std::vector<Stretch> stretches_;
  double near_mm_;  // nearer than this one of the stretched distances may be nearer than kNear_mm
  bool isotropic_;  // the formalism needs no angle
  bool folds_;      // whether angles beyond 90° have the values of those below
  int angles_;      // entries for each radius
  double steps_per_rad_ = 0.0;
  std::vector<float> scaled_;  // (radii × angles_) r² times the dose rate; the angles of one radius lie together
};

/// Sum of the dose rates of sources at points by a table, on all cores: [cGy/h] for weights in U.
/// @param rates (points.size()), overwritten
void sum_rates(const RateTable& table, std::span<const PlacedSource> sources, std::span<const Vec3> points,
               std::span<double> rates);

}  // namespace stylet
