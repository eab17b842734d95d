// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "serving.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/structure_samples.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/implant/needle_insertion.hpp"

#include <functional>
#include <memory>

namespace stylet::test {

/// A plan of two needles with three and two seeds in the gland of box_patient(), which has 20 cc.
inline std::shared_ptr<const serve::ImplantCase> small_implant(double step_mm = 1.0) {
  auto implant = std::make_shared<serve::ImplantCase>();
  implant->plan.file = "plan.csv";
  implant->plan.prescription_Gy = 20.0;  // five seeds do not reach more
  const auto add = [&](const char* needle, double x, double y, double z) {
    PlannedSource seed;
    seed.at_mm = Vec3(x, y, z);
    seed.has_axis = true;
    seed.strength_U = 0.8;
    seed.needle = needle;
    implant->plan.sources.push_back(seed);
  };
  for (const double z : {24.0, 33.0, 42.0}) add("left", 5, 5, z);
  for (const double z : {26.0, 36.0}) add("right", -5, 5, z);
  implant->source = *find_source("i125_6711");
  implant->needles = *load_needles(implant->plan, implant->source.outer_length_mm, 0.0);
  DoseStructure gland;
  gland.name = gland.region = "prostate";
  gland.samples = *sample_structure(box_patient(), 1, step_mm);
  implant->structures.push_back(std::move(gland));
  const auto goals = permanent_prostate_goals();
  implant->options.goals.assign(goals.begin(), goals.end());
  implant->options.swelling.at_start = Vec3::Constant(0.145);
  implant->options.swelling.centre_mm = Vec3(0, 5, 32);
  return implant;
}

/// A server whose case has this plan. The model has the plan's first needle.
/// @param change of the scenario
inline serve::CaseSource implant_case(const std::function<void(Scenario&)>& change = {}) {
  return {"implant", [change](const Progress& progress) -> Result<serve::LoadedCase> {
            Scenario scenario = box_scenario();
            scenario.procedure.technique = SeedTechnique::pushed;
            if (change) change(scenario);
            scenario.insertions.clear();
            scenario.plan.file = "plan.csv";
            const auto implant = small_implant();
            const TetMesh mesh = box_patient();
            const Topology topology(mesh);
            auto first = needle_insertion(implant->needles.front(), scenario, Locator(mesh, topology), "case.toml");
            if (!first) return first.error();
            scenario.insertions = {*first};
            auto model = Model::compile(scenario, mesh, "case.toml", {}, progress);
            if (!model) return model.error();
            return serve::LoadedCase{*model, {}, implant};
          }};
}

}  // namespace stylet::test
