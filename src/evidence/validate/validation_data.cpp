// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation_data.hpp"

#include "evidence/reproduce/page_text.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/measure/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json outputs_json(const Outputs& outputs) {
  return {{"peak_axial_N", number(outputs.peak_axial_N)},
          {"target_shift_mm", number(outputs.target_shift_mm)},
          {"tip_deflection_mm", number(outputs.tip_deflection_mm)}};
}

Json sensitivity_json(const Sensitivity& study) {
  Json influences = Json::array();
  for (const Influence& i : study.influences) {
    influences.push_back({{"key", i.key},
                          {"meaning", i.meaning},
                          {"unit", i.unit},
                          {"base", i.base},
                          {"low", i.low},
                          {"high", i.high},
                          {"at_low", outputs_json(i.at_low)},
                          {"at_high", i.high.empty() ? Json(nullptr) : outputs_json(i.at_high)},
                          {"note", i.note}});
  }
  return {{"change", study.change},   {"scenario", study.scenario}, {"base", outputs_json(study.base)},
          {"influences", influences}, {"threads", study.threads},   {"seconds", study.seconds}};
}

Json row_json(const Row& row) {
  const bool judged = row.verdict == Verdict::pass || row.verdict == Verdict::missed;
  Json curves = Json::array();
  for (const Curve& curve : row.finding.plot.curves) curves.push_back(curve.label);
  return {{"id", row.spec.id},
          {"group", to_string(row.spec.group)},
          {"claim", row.spec.claim},
          {"reference", row.spec.reference},
          {"value", number(row.finding.value)},
          {"unit", row.spec.unit},
          {"tolerance", row.spec.accepted.text()},
          {"accepted_from", number(row.spec.accepted.from)},
          {"accepted_to", number(row.spec.accepted.to)},
          {"pass", judged ? Json(row.verdict == Verdict::pass) : Json(nullptr)},
          {"verdict", to_string(row.verdict)},
          {"skipped", row.verdict == Verdict::skipped},
          {"note", row.note()},
          {"seconds", row.seconds},
          {"curves", curves},
          {"csv", curves.empty() ? Json(nullptr) : Json(curve_file(row))}};
}

constexpr std::size_t kMostPoints = 400;

/// Indices of the points to draw: the lowest and the highest value of each section, which keep the shape of a curve in
/// a small picture.
std::vector<std::size_t> thinned(const std::vector<double>& y) {
  std::vector<std::size_t> kept;
  if (y.size() <= kMostPoints) {
    for (std::size_t i = 0; i < y.size(); ++i) kept.push_back(i);
    return kept;
  }
  const std::size_t stretches = kMostPoints / 2;
  for (std::size_t k = 0; k < stretches; ++k) {
    const auto from = y.begin() + static_cast<std::ptrdiff_t>(k * y.size() / stretches);
    const auto to = y.begin() + static_cast<std::ptrdiff_t>((k + 1) * y.size() / stretches);
    const auto [low, high] = std::minmax_element(from, to);
    const auto a = static_cast<std::size_t>(low - y.begin());
    const auto b = static_cast<std::size_t>(high - y.begin());
    kept.push_back(std::min(a, b));
    if (a != b) kept.push_back(std::max(a, b));
  }
  return kept;
}

/// Rounds to six digits, which is enough for a picture.
double rounded(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.6g}", value)) : value; }

Json curve_json(const Curve& curve) {
  Json x = Json::array();
  Json y = Json::array();
  for (const std::size_t i : thinned(curve.y)) {
    x.push_back(number(rounded(curve.x[i])));
    y.push_back(number(rounded(curve.y[i])));
  }
  const char* kind = curve.kind == Curve::Kind::points      ? "points"
                     : curve.kind == Curve::Kind::reference ? "reference"
                                                            : "ours";
  return {{"label", curve.label}, {"kind", kind}, {"x", x}, {"y", y}};
}

Json plot_json(const Plot& plot) {
  Json curves = Json::array();
  for (const Curve& curve : plot.curves) curves.push_back(curve_json(curve));
  Json band = nullptr;
  if (plot.band) band = {{"from", number(plot.band->from)}, {"to", number(plot.band->to)}};
  return {{"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"log_x", plot.log_x},
          {"log_y", plot.log_y},
          {"band", band},
          {"curves", curves}};
}

}  // namespace

std::string curve_file(const Row& row) { return row.spec.id + ".csv"; }

std::string value_text(double value) {
  if (std::isnan(value)) return "–";
  const std::string text = reproduce::digits(std::abs(value));
  return value < 0.0 && text != "0" ? "−" + text : text;
}

std::string accepted_text(const Accepted& accepted) {
  const auto bound = [](double value) {
    const bool plain = value == 0.0 || (std::abs(value) >= 1e-4 && std::abs(value) < 1e5);
    return plain ? fmt::format("{}{:g}", value < 0.0 ? "−" : "", std::abs(value)) : value_text(value);
  };
  if (accepted.from && accepted.to) return bound(*accepted.from) + " … " + bound(*accepted.to);
  if (accepted.from) return "≥ " + bound(*accepted.from);
  if (accepted.to) return "≤ " + bound(*accepted.to);
  return "for information";
}

Json validation_data(const Validation& v) {
  Json rows = Json::array();
  for (const Row& row : v.rows) rows.push_back(row_json(row));
  const measure::Machine machine = measure::this_machine();
  return {{"version", v.version},
          {"command", v.options.command},
          {"quick", v.options.quick},
          {"seconds", v.seconds},
          {"machine",
           {{"processor", machine.processor},
            {"cores", machine.cores},
            {"blas", machine.blas},
            {"compiler", machine.compiler}}},
          {"passed", v.count(Verdict::pass)},
          {"missed", v.count(Verdict::missed)},
          {"skipped", v.count(Verdict::skipped)},
          {"information", v.count(Verdict::information)},
          {"crashed", v.count(Verdict::crashed)},
          {"rows", rows},
          {"sensitivity", v.sensitivity ? sensitivity_json(*v.sensitivity) : Json(nullptr)}};
}

Json page_data(const Validation& v) {
  Json plots = Json::object();
  for (const Row& row : v.rows) {
    if (!row.finding.plot.curves.empty()) plots[row.spec.id] = plot_json(row.finding.plot);
  }
  return {{"plots", plots}, {"sensitivity", v.sensitivity ? sensitivity_json(*v.sensitivity) : Json(nullptr)}};
}

std::string validation_json(const Validation& validation) { return json_text(validation_data(validation), 1) + "\n"; }

}  // namespace stylet::validate
