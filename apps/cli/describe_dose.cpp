// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptions of plans, dose grids and source models.
#include "describe.hpp"
#include "table.hpp"

#include "stylet/dose/fitting_sources.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/plan_rules.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <map>

namespace stylet::cli {

namespace {

std::string with_notes(std::string text, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) text += "\n  note: " + note;
  return text;
}

/// The findings of the rules for plans without structures, by the models that the plan names or that fit.
std::vector<std::string> doubts_of(const DosePlan& plan) {
  std::vector<SourceModel> models;
  for (std::size_t kind = 0; kind < kind_count(plan); ++kind) {
    const SourceKind says = source_kind(plan, kind);
    const Result<SourceModel> named = find_source(says.source_model);
    const std::vector<SourceModel> fits = fitting_sources(says);
    if (!named && fits.empty()) return {};
    models.push_back(named ? *named : fits.front());
  }
  const Result<std::vector<std::string>> judged = judge_plan(plan, models, {}, {});
  return judged ? *judged : std::vector<std::string>{"stylet dose refuses this plan: " + judged.error().message()};
}

}  // namespace

Description describe(const DosePlan& plan) {
  std::vector<std::string> notes = plan.notes;
  const std::vector<std::string> doubts = doubts_of(plan);
  notes.insert(notes.end(), doubts.begin(), doubts.end());
  Eigen::AlignedBox3d box;
  double strength_U = 0.0, dwell_s = 0.0;
  std::size_t turned = 0;
  std::map<double, int> strengths;
  std::map<std::string, int> needles;
  for (const PlannedSource& s : plan.sources) {
    box.extend(s.at_mm);
    strength_U += s.strength_U;
    dwell_s += s.dwell_s;
    turned += s.has_axis ? 1 : 0;
    ++strengths[s.strength_U];
    if (!s.needle.empty()) ++needles[s.needle];
  }
  const bool temporary = plan.implant == Implant::temporary;
  std::vector<std::string> fits;
  for (const SourceModel& source : fitting_sources(plan)) fits.push_back(source.name);
  std::string strength_text, fits_text;
  for (const auto& [strength, count] : strengths)
    strength_text += fmt::format("{}{} × {:g} U", strength_text.empty() ? "" : ", ", count, strength);
  for (const std::string& name : fits) fits_text += (fits_text.empty() ? "" : ", ") + name;

  Facts facts;
  facts.add("kind", fmt::format("plan of a {} implant", to_string(plan.implant)));
  if (!plan.label.empty()) facts.add("label", plan.label);
  facts.add(temporary ? "dwell positions" : "seeds", fmt::to_string(plan.sources.size()));
  if (temporary) facts.add("time in all", fmt::format("{:.1f} s", dwell_s));
  if (!needles.empty()) facts.add("needles", fmt::to_string(needles.size()));
  facts.add("strengths", strength_text);
  if (!temporary) facts.add("strength in all", fmt::format("{:.3f} U", strength_U));
  if (!plan.strength_date.empty()) facts.add("date of the strengths", plan.strength_date);
  facts.add("isotope", plan.isotope.empty() ? "(not said)" : plan.isotope);
  if (plan.half_life_days > 0) facts.add("half-life", fmt::format("{:g} d", plan.half_life_days));
  if (plan.source_length_mm > 0) facts.add("length of the source", fmt::format("{:g} mm", plan.source_length_mm));
  facts.add("source model", plan.source_model.empty() ? "(not named) these fit: " + fits_text : plan.source_model);
  facts.add("with direction", fmt::format("{} of {}", turned, plan.sources.size()));
  facts.add("prescription", plan.prescription_Gy > 0 ? fmt::format("{:g} Gy", plan.prescription_Gy) : "(not said)");
  facts.add("extent", extent_text(box) + " mm");
  if (!plan.frame_of_reference.empty()) facts.add("frame of reference", plan.frame_of_reference);

  Description out;
  out.json = {{"kind", "plan"},
              {"implant", to_string(plan.implant)},
              {"label", plan.label},
              {temporary ? "dwell_positions" : "seeds", plan.sources.size()},
              {"needles", needles.size()},
              {"strength_total_U", strength_U},
              {"dwell_total_s", dwell_s},
              {"with_axis", turned},
              {"isotope", plan.isotope},
              {"half_life_days", plan.half_life_days},
              {"source_length_mm", plan.source_length_mm},
              {"source", plan.source_model},
              {"fitting_sources", fits},
              {"prescription_Gy", plan.prescription_Gy > 0 ? Json(plan.prescription_Gy) : Json(nullptr)},
              {"extent_mm", extent_json(box)},
              {"frame_of_reference", plan.frame_of_reference},
              {"notes", notes}};
  out.text = with_notes(facts.text(), notes);
  return out;
}

Description describe(const DoseGrid& grid) {
  Eigen::AlignedBox3d box;
  for (const Index i : {0, grid.size[0] - 1}) {
    for (const Index j : {0, grid.size[1] - 1}) {
      for (const Index k : {0, grid.size[2] - 1}) box.extend(grid.point(i, j, k));
    }
  }
  const double highest =
      grid.dose_Gy.empty() ? 0.0 : static_cast<double>(*std::max_element(grid.dose_Gy.begin(), grid.dose_Gy.end()));
  Facts facts;
  facts.add("kind", "dose grid");
  facts.add("points", fmt::format("{} × {} × {}", grid.size[0], grid.size[1], grid.size[2]));
  facts.add("spacing",
            fmt::format("{:g} × {:g} × {:g} mm", grid.spacing_mm.x(), grid.spacing_mm.y(), grid.spacing_mm.z()));
  facts.add("extent", extent_text(box) + " mm");
  facts.add("z", fmt::format("{:g} … {:g} mm", box.min().z(), box.max().z()));
  facts.add("highest dose", fmt::format("{:.4g} Gy", highest));
  facts.add("stored in steps of", fmt::format("{:.3g} Gy", grid.quantum_Gy));
  if (!grid.frame_of_reference.empty()) facts.add("frame of reference", grid.frame_of_reference);
  Description out;
  out.json = {{"kind", "dose"},
              {"size", grid.size},
              {"spacing_mm", {grid.spacing_mm.x(), grid.spacing_mm.y(), grid.spacing_mm.z()}},
              {"extent_mm", extent_json(box)},
              {"highest_Gy", highest},
              {"quantum_Gy", grid.quantum_Gy},
              {"frame_of_reference", grid.frame_of_reference},
              {"notes", grid.notes}};
  out.text = with_notes(facts.text(), grid.notes);
  return out;
}

Description describe(const SourceModel& source) {
  Facts facts;
  facts.add("kind", "source model");
  facts.add("name", source.name);
  facts.add("source", source.title);
  facts.add("isotope", fmt::format("{}, half-life {:g} d", source.isotope, source.half_life_days));
  facts.add("dose-rate constant", fmt::format("{:g} cGy/(h U)", source.dose_rate_constant));
  facts.add("active length", fmt::format("{:g} mm", source.active_length_mm));
  facts.add("capsule",
            fmt::format("{:g} mm long, {:g} mm in diameter", source.outer_length_mm, source.outer_diameter_mm));
  facts.add("g_L",
            fmt::format("{} radii, {:g} … {:g} mm", source.g.size(), source.g_r_mm.front(), source.g_r_mm.back()));
  facts.add("F", fmt::format("{} angles × {} radii", source.F.rows(), source.F.cols()));
  facts.add("φ_an", source.phi.empty() ? "computed from F" : fmt::format("{} radii", source.phi.size()));
  facts.add("citation", source.citation);
  Description out;
  out.json = {{"kind", "source"},
              {"name", source.name},
              {"title", source.title},
              {"isotope", source.isotope},
              {"half_life_days", source.half_life_days},
              {"dose_rate_constant", source.dose_rate_constant},
              {"active_length_mm", source.active_length_mm},
              {"outer_length_mm", source.outer_length_mm},
              {"outer_diameter_mm", source.outer_diameter_mm},
              {"citation", source.citation}};
  out.text = facts.text();
  return out;
}

Description describe_known_sources() {
  Table table({"name", "source", "isotope", "half-life [d]", "L [mm]", "Λ [cGy/(h U)]"});
  Description out;
  out.json = {{"kind", "sources"}, {"sources", Json::array()}};
  for (const SourceModel& source : known_sources()) {
    table.row({source.name, source.title, source.isotope, fmt::format("{:g}", source.half_life_days),
               fmt::format("{:g}", source.active_length_mm), fmt::format("{:g}", source.dose_rate_constant)});
    out.json["sources"].push_back(describe(source).json);
  }
  out.text = table.text();
  return out;
}

}  // namespace stylet::cli
