// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/model.hpp"

#include "needle_choice.hpp"
#include "planning.hpp"
#include "stylet/geom/flat_tets.hpp"
#include "stylet/needle/guided.hpp"
#include "stylet/needle/make_needle.hpp"
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace stylet {

namespace {

/// Number of point loads of a needle with `capacity` shaft contacts: the tip and a guide add one each.
int needle_loads(int capacity) { return capacity + 2; }

Result<std::unique_ptr<Needle>> build_needle(const Scenario::NeedleChoice& n, int capacity) {
  const auto section = needle_section(n);
  if (!section) return section.error();
  return make_needle(word(n.model), *section, n.elements, needle_loads(capacity));
}

}  // namespace

Result<std::shared_ptr<const Model>> Model::compile(const Scenario& scenario, TetMesh mesh, const std::string& where,
                                                    const std::vector<std::vector<MotionSample>>& motions,
                                                    const Progress& progress, std::optional<ModelCompliance> known) {
  if (auto checked = check_compilable(scenario, mesh, where); !checked) return checked.error();
  if (const auto needle = build_needle(scenario.needle, scenario.coupling.contacts); !needle)
    return within(where, needle.error());
  std::shared_ptr<Model> model(new Model);
  model->scenario_ = scenario;
  model->coupling_ = coupling_settings(scenario);
  model->regions_ = region_tissue(scenario, mesh);
  std::vector<std::string>& warnings = model->warnings_;
  warnings = warnings_before_start(scenario);
  if (std::string flat = nearly_flat_warning(mesh); !flat.empty()) warnings.push_back(std::move(flat));

  // The insertions are planned before the supports, because outer faces near an entry stay free.
  Topology topology(mesh);
  auto plans = plan_insertions(scenario, mesh, topology, model->regions_.target, motions, where, warnings);
  if (!plans) return plans.error();
  model->insertions_ = *std::move(plans);
  const std::vector<PlannedInsertion> all = model->insertions_.all();
  auto supports = hold_tissue(scenario, mesh, topology, all, model->regions_, where);
  if (!supports) return supports.error();
  model->supports_ = *std::move(supports);
  for (std::string& warning : tissue_warnings(scenario, mesh.regions, model->regions_))
    warnings.push_back(std::move(warning));

  auto built = build_tissue(scenario, std::move(mesh), std::move(topology), model->regions_, model->supports_, all,
                            known.has_value(), where, warnings, progress);
  if (!built) return built.error();
  model->built_ = *std::move(built);
  auto compliance =
      prepare_compliance(scenario, model->built_, model->regions_.laws, all, std::move(known), where, progress);
  if (!compliance) return compliance.error();
  model->compliance_ = *std::move(compliance);
  return std::shared_ptr<const Model>(std::move(model));
}

Result<std::shared_ptr<const Model>> Model::with(OwnParts parts) const {
  std::shared_ptr<Model> model(new Model(*this));
  const auto warn = [&](const char* what, const std::string& name) {
    model->warnings_.push_back(fmt::format(
        "{} \"{}\" is a part of the program that made this model. The scenario does not describe it, so the "
        "stylet program computes other results from this scenario.",
        what, name));
  };
  if (parts.needle) {
    const auto section = needle_section(scenario_.needle);
    if (!section) return section.error();
    const auto needle = parts.needle(*section, needle_loads(coupling_.capacity));
    if (!needle) return needle.error();
    if (*needle == nullptr)
      return failure("own needle", "OwnParts::needle returned a null pointer", "Return a needle or an error");
    if (const double length = (*needle)->length(); std::abs(length - section->length_mm) > 1e-9 * section->length_mm) {
      return input_error("own needle \"" + (*needle)->model() + "\"",
                         fmt::format("it is {:g} mm long, and needle.length_mm is {:g}", length, section->length_mm),
                         "Give both the same length");
    }
    warn("The needle", (*needle)->model());
  }
  if (parts.cutting) warn("The law of cutting", parts.cutting->name());
  model->coupling_.cutting = parts.cutting;
  model->own_ = std::move(parts);
  return std::shared_ptr<const Model>(std::move(model));
}

std::unique_ptr<Needle> Model::make_needle() const {
  // Both succeed, since compile() and with() have built one.
  auto needle = own_.needle ? own_.needle(*needle_section(scenario_.needle), needle_loads(coupling_.capacity))
                            : build_needle(scenario_.needle, coupling_.capacity);
  if (!needle) return nullptr;
  if (!scenario_.grid.guide) return std::move(*needle);
  GuideHole hole;
  hole.clearance_mm = scenario_.grid.clearance_mm;
  return std::make_unique<GuidedNeedle>(std::move(*needle), hole, coupling_.capacity + 1);
}

}  // namespace stylet
