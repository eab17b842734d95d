// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/rate_table.hpp"

#include <span>
#include <vector>

namespace stylet::dose {

/// The dose of one kind of source over all parts of an implant's time. Swelling that is the same in all directions only
/// makes distances longer, so one table of the mean rate serves for all parts; otherwise the sources are summed for
/// each part.
class DoseOfKind {
 public:
  /// @param kind of source, whose model tg43 has
  DoseOfKind(const Tg43& tg43, const DosePlan& plan, const DoseOptions& options, std::size_t kind);

  /// Dose [Gy] at points [mm] by the formula itself, summed over all sources for each part of the time.
  [[nodiscard]] std::vector<double> by_formula(const std::vector<Vec3>& points) const;
  /// The same by the table.
  [[nodiscard]] std::vector<double> by_table(const std::vector<Vec3>& points) const;

 private:
  /// @param rates Tg43 or RateTable
  template <class Rates>
  [[nodiscard]] std::vector<double> by_parts(const std::vector<Vec3>& points, const Rates& rates) const;

  Tg43 tg43_;
  Swelling swelling_;
  WeightedSources weighted_;
  std::vector<SwollenTime> times_;
  bool alike_;  ///< whether the swelling is the same in all directions
  RateTable table_;
};

/// The sum over all kinds of source.
class SummedDose {
 public:
  /// @param models one for each kind of source
  /// Errors: not one model for each kind; those of Tg43::create().
  static Result<SummedDose> create(const DosePlan& plan, std::span<const SourceModel> models,
                                   const DoseOptions& options);

  [[nodiscard]] std::vector<double> by_formula(const std::vector<Vec3>& points) const;
  [[nodiscard]] std::vector<double> by_table(const std::vector<Vec3>& points) const;

 private:
  template <class Of>
  [[nodiscard]] std::vector<double> sum(std::size_t count, const Of& of) const;
  std::vector<DoseOfKind> kinds_;
};

}  // namespace stylet::dose
