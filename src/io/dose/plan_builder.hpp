// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dose/needle_train.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/sim/scenario.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet::detail {

/// Where the holes of the template are, for needles with trains.
struct PlanTemplate {
  TemplateGrid grid;
  Vec3 origin_mm = Vec3::Zero();   ///< [mm] LPS, where the axis of hole D4 meets the base plane (retraction 0)
  Vec3 direction = Vec3::UnitZ();  ///< from the template to the base: superior
  Vec3 left = Vec3::UnitX();       ///< towards the patient's left
  Vec3 anterior = -Vec3::UnitY();  ///< towards anterior
  TrainLengths lengths;
  std::optional<double> tip_offset_mm;  ///< superior end of a train beyond the retraction plane; half a seed if unset
};

/// A needle with its train of seeds and spacers.
struct PlanNeedle {
  std::string hole, train;
  std::optional<Vec3> at_mm;     ///< [mm] LPS, where its line meets the base plane, instead of a hole
  std::vector<double> seeds_mm;  ///< distances of the seeds' centres from the retraction plane, instead of a train
  std::string name;              ///< of a needle without a hole
  double retraction_mm = 0.0;
  double strength_U = 0.0;
};

/// Puts a plan together from the rows of a text file and checks each of them.
class PlanBuilder {
 public:
  explicit PlanBuilder(std::string file) { plan.file = std::move(file); }

  /// Adds a seed or dwell position. Errors: a strength that is missing or not above 0; a dwell time below 0; a place
  /// out of reach; an axis without length. Whether the numbers are plausible, plan_rules.hpp judges.
  /// @param where file and row, for messages
  Result<> add(PlannedSource source, const std::string& where);

  /// Adds the seeds of a needle. Errors: an unknown hole, a malformed train, the errors of add().
  Result<> add(const PlanNeedle& needle, const PlanTemplate& grid, const std::string& where);

  /// The kind of source of a seed that names its model; the plan's first kind where it names none.
  /// Errors: some seeds name a model and others do not, and the plan does not name one for all.
  Result<std::size_t> kind_of(const std::string& model, const std::string& where);

  /// The plan, if it has a source.
  Result<DosePlan> finish();

  DosePlan plan;

 private:
  bool named_by_seeds_ = false;
};

}  // namespace stylet::detail
