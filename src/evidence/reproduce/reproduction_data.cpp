// SPDX-License-Identifier: GPL-3.0-or-later
#include "reproduction_data.hpp"

#include "io/results/report/text.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/io/event_words.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::reproduce {

namespace {

Json point_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json points_json(const std::vector<Vec3>& points) {
  Json list = Json::array();
  for (const Vec3& p : points) list.push_back(point_json(p));
  return list;
}

Json segment_json(const Figure2::Segment& segment) {
  return {{"points_mm", points_json(segment.points)}, {"tets", segment.tets}};
}

/// A number; null for NaN and infinity, which JSON does not have.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json cell_json(const TableCell& cell) {
  if (const auto* value = std::get_if<double>(&cell)) return number(*value);
  if (const auto* words = std::get_if<std::string>(&cell)) return *words;
  return nullptr;
}

Json refused_json(RemeshEvent::Refused refused) {
  return refused == RemeshEvent::Refused::no ? Json(nullptr) : Json(to_string(refused));
}

Json figure5_json(const std::vector<Figure5Row>& rows) {
  Json list = Json::array();
  for (const Figure5Row& row : rows) {
    list.push_back({{"dim", row.dim},
                    {"change", row.change},
                    {"inverse_s", row.inverse_s},
                    {"bcs_s", row.bcs_s},
                    {"woodbury_s", row.woodbury_s},
                    {"woodbury_symmetric_s", row.woodbury_symmetric_s},
                    {"largest_error", row.largest_error},
                    {"repeats", row.repeats},
                    {"added", row.added},
                    {"bcs_multiplications", row.bcs_multiplications},
                    {"woodbury_multiplications", row.woodbury_multiplications}});
  }
  return list;
}

Json run_json(const Figure6Run& run) {
  Json events = Json::array();
  std::vector<results::EventWords> words;  // of each insertion
  for (const Figure6Event& e : run.events) {
    words.resize(std::max(words.size(), e.insertion + 1));
    events.push_back({{"kind", to_string(e.event.kind)},
                      {"region", e.event.region},
                      {"label", words[e.insertion].label(e.event)},
                      {"insertion", e.insertion + 1},
                      {"iteration", e.iteration},
                      {"time_s", e.event.time_s},
                      {"depth_mm", e.event.depth_mm},
                      {"force_N", number(e.event.force_N)}});
  }
  Json remeshings = Json::array();
  for (const Figure6Remesh& r : run.remeshes) {
    remeshings.push_back({{"kind", to_string(r.event.kind)},
                          {"not_moved_because", refused_json(r.event.refused)},
                          {"insertion", r.insertion + 1},
                          {"iteration", r.iteration},
                          {"dimension", r.event.dimension},
                          {"elements", r.event.elements},
                          {"moved_mm", r.event.moved_mm},
                          {"condition", number(r.event.condition)},
                          {"step_us", run.steps[r.iteration].step_us}});
  }
  return {{"id", run.variant.id},
          {"label", run.variant.label},
          {"method", run.variant.method},
          {"rule", run.variant.rule},
          {"engine", run.variant.engine},
          {"csv", curve_file(run)},
          {"iterations", run.steps.size()},
          {"total_s", run.total_s()},
          {"worst_ms", {{"with_remeshing", 1e3 * run.worst_s(true)}, {"without", 1e3 * run.worst_s(false)}}},
          {"median_ms",
           {{"with_remeshing", number(1e3 * run.median_s(true))}, {"without", number(1e3 * run.median_s(false))}}},
          {"compliance_mb", run.compliance_mb},
          {"not_converged", run.not_converged},
          {"events", events},
          {"remeshings", remeshings}};
}

Json figure6_json(const Figure6& figure) {
  Json curves = Json::object();
  Json runs = Json::array();
  for (const Figure6Run& run : figure.runs) {
    curves[run.variant.id] = curve_file(run);
    runs.push_back(run_json(run));
  }
  return {{"mesh", {{"nodes", figure.nodes}, {"tets", figure.tets}, {"free_dofs", figure.free_dofs}}},
          {"dt_ms", figure.dt_ms},
          {"speed_mm_per_s", figure.speed_mm_per_s},
          {"repeats", figure.repeats},
          {"insertions", figure.insertions},
          {"curves", curves},
          {"runs", runs}};
}

Json table_json(const std::vector<TableRow>& rows) {
  Json list = Json::array();
  for (const TableRow& row : rows) {
    list.push_back({{"group", row.group},
                    {"quantity", row.quantity},
                    {"unit", row.unit},
                    {"paper", cell_json(row.paper)},
                    {"reproduced", cell_json(row.reproduced)},
                    {"default", cell_json(row.ours)},
                    {"note", row.note}});
  }
  return list;
}

template <class Value>
std::string column(const std::vector<Step>& steps, Value value) {
  std::vector<float> values;
  values.reserve(steps.size());
  for (const Step& step : steps) values.push_back(static_cast<float>(value(step)));
  return results::base64_of<float>(values);
}

}  // namespace

std::string curve_file(const Figure6Run& run) { return "figure6_" + run.variant.id + ".csv"; }

Json figure2_json(const Figure2& figure) {
  Json contours = Json::array();
  for (const CulledContour& contour : figure.contours) {
    contours.push_back({{"points_mm", points_json(contour.points)}, {"kept", contour.kept}});
  }
  return {{"organ", figure.organ},
          {"cull_mm", figure.cull_mm},
          {"points", figure.points()},
          {"points_kept", figure.points_kept()},
          {"contours", contours},
          {"surface", {{"points_mm", points_json(figure.surface_points)}, {"triangles", figure.surface_triangles}}},
          {"needle_segment",
           {{"symmetric", segment_json(figure.symmetric)}, {"asymmetric", segment_json(figure.asymmetric)}}}};
}

Json curves_json(const Figure6Run& run) {
  double cumulative_s = 0.0;
  return {{"cumulative_s", column(run.steps, [&](const Step& s) { return cumulative_s += 1e-6 * s.step_us; })},
          {"axial_N", column(run.steps, [](const Step& s) { return s.force_axial_N; })},
          {"sagittal_N", column(run.steps, [](const Step& s) { return s.force_sagittal_N; })},
          {"lateral_N", column(run.steps, [](const Step& s) { return s.force_lateral_N; })}};
}

Json reproduction_data(const Reproduction& r) {
  return {{"version", r.version},
          {"quick", r.options.quick},
          {"command", r.options.command},
          {"seconds", r.seconds},
          {"machine",
           {{"processor", r.machine.processor},
            {"cores", r.machine.cores},
            {"blas", r.machine.blas},
            {"blas_threads", r.machine.blas_threads > 0 ? Json(r.machine.blas_threads) : Json(nullptr)},
            {"compiler", r.machine.compiler}}},
          {"fig2",
           {{"file", "figure2.json"},
            {"organ", r.figure2.organ},
            {"points", r.figure2.points()},
            {"points_kept", r.figure2.points_kept()}}},
          {"fig5", figure5_json(r.figure5)},
          {"fig6", figure6_json(r.figure6)},
          {"table", table_json(r.table)},
          {"notes", r.notes}};
}

std::string reproduction_json(const Reproduction& reproduction) {
  return json_text(reproduction_data(reproduction), 1) + "\n";
}

}  // namespace stylet::reproduce
