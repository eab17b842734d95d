// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded insertions of bevelled, unsteered needles: the model is fitted to two recordings and predicts the other two.
#include "../number_table.hpp"
#include "../rows.hpp"
#include "../scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace stylet::validate {

namespace {

constexpr std::array kFitted{"exp_b1_00a.csv", "exp_b1_00b.csv"};
constexpr std::array kPredicted{"exp_b1_00c.csv", "exp_b1_00d.csv"};
constexpr double kDeepest_mm = 100.0;
constexpr double kEvery_mm = 5.0;
constexpr double kInsertionSpeed_mm_per_s = 2.0;  ///< 100 mm in about a minute

/// Lateral position of the tip over depth, relative to the entry point.
struct TipRecording {
  std::string name;
  std::vector<double> depth_mm;
  std::vector<double> lateral_mm;
};

/// Reads a recording. @return the recording, sampled every 5 mm of depth
TipRecording read(const std::filesystem::path& file) {
  const auto columns = need(read_number_table(file, {"Tip x", "Tip y"}));
  std::vector<std::pair<double, double>> samples;  // depth, lateral
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    const double y = columns[1][i];
    if (y != 0.0) samples.emplace_back(-y, columns[0][i]);  // exactly 0 marks samples without a reading
  }
  std::sort(samples.begin(), samples.end());
  std::vector<double> depth;
  std::vector<double> lateral;
  for (const auto& [z, x] : samples) {
    if (!depth.empty() && z - depth.back() < 1e-6) continue;
    depth.push_back(z);
    lateral.push_back(x);
  }
  if (depth.size() < 10)
    throw Failed{input_error(file.string(), "there are fewer than 10 readings", "Use the file as it was published")};
  TipRecording out{.name = file.stem().string(), .depth_mm = {}, .lateral_mm = {}};
  const double start = interpolated(depth, lateral, 0.0);
  for (double z = kEvery_mm; z <= kDeepest_mm; z += kEvery_mm) {
    out.depth_mm.push_back(z);
    out.lateral_mm.push_back(interpolated(depth, lateral, z) - start);
  }
  return out;
}

/// Lateral position of the simulated tip, every 5 mm of depth.
std::vector<double> simulate(double bevel_deg) {
  Block block = Block::of_one_tissue();
  block.hi.z() = 125.0;
  block.cells[2] = 10;
  block.depth_mm = kDeepest_mm;
  block.scenario.needle.bevel_deg = bevel_deg;
  const auto model = need(block.compile());
  Drive drive(model, 0.0);
  std::vector<double> lateral;
  for (double z = kEvery_mm; z <= kDeepest_mm; z += kEvery_mm) {
    drive.go(z, kInsertionSpeed_mm_per_s, 25e-3);
    lateral.push_back(drive.last().record.tip_mm.x() - model->insertions().front().entry.x());
  }
  return lateral;
}

/// Fitted bevel angle and heading, and the remaining error for the fitted recordings.
struct Fit {
  double bevel_deg = 0.0;
  double heading = 0.0;  ///< slope of the guide against the tracker's axis
  double rms_mm = 1e300;
  std::vector<double> lateral_mm;  ///< heading included
};

double rms(const std::vector<double>& lateral, const std::vector<TipRecording>& recordings) {
  double sum = 0.0;
  double count = 0.0;
  for (const TipRecording& r : recordings) {
    for (std::size_t i = 0; i < lateral.size(); ++i) sum += std::pow(r.lateral_mm[i] - lateral[i], 2);
    count += static_cast<double>(lateral.size());
  }
  return std::sqrt(sum / count);
}

/// Computes the best heading for a bevel angle by least squares.
Fit fit_heading(double bevel_deg, const std::vector<TipRecording>& recordings) {
  auto lateral = simulate(bevel_deg);
  double top = 0.0;
  double bottom = 0.0;
  for (const TipRecording& r : recordings) {
    for (std::size_t i = 0; i < lateral.size(); ++i) {
      top += r.depth_mm[i] * (r.lateral_mm[i] - lateral[i]);
      bottom += r.depth_mm[i] * r.depth_mm[i];
    }
  }
  Fit fit{.bevel_deg = bevel_deg, .heading = top / bottom, .lateral_mm = std::move(lateral)};
  for (std::size_t i = 0; i < fit.lateral_mm.size(); ++i) fit.lateral_mm[i] += fit.heading * recordings[0].depth_mm[i];
  fit.rms_mm = rms(fit.lateral_mm, recordings);
  return fit;
}

Fit best_fit(const std::vector<TipRecording>& recordings) {
  Fit best;
  double low = 0.0;
  double high = 40.0;
  for (int round = 0; round < 2; ++round) {
    const double step = (high - low) / 8.0;
    for (int k = 0; k <= 8; ++k) {
      auto fit = fit_heading(low + step * k, recordings);
      if (fit.rms_mm < best.rms_mm) best = std::move(fit);
    }
    low = std::max(0.0, best.bevel_deg - step);
    high = std::min(40.0, best.bevel_deg + step);
  }
  return best;
}

Finding predict(Context& context) {
  const auto read_all = [&](const auto& names) {
    std::vector<TipRecording> all;
    for (const char* name : names) all.push_back(read(need_file(context, std::string("needle_tip_tracking/") + name)));
    return all;
  };
  const auto fitted = read_all(kFitted), others = read_all(kPredicted);
  const auto fit = best_fit(fitted);
  const auto straight = fit_heading(0.0, fitted);

  Finding finding;
  const double unbevelled = rms(straight.lateral_mm, others);
  finding.value = rms(fit.lateral_mm, others);
  if (finding.value >= unbevelled) finding.value = std::numeric_limits<double>::quiet_NaN();
  std::string ends;
  for (const TipRecording& r : others)
    ends +=
        fmt::format("{}{:.2f} mm", ends.empty() ? "" : " and ", std::abs(fit.lateral_mm.back() - r.lateral_mm.back()));
  finding.note = fmt::format(
      "Fitted to two recordings: a bevel of {:.1f}° (needles are ground to 10° … 30°) and a heading of the guide of "
      "{:.1f}°, with an RMS error of {:.2f} mm. The other two are predicted; the error at 100 mm is {}. There, {:.1f} "
      "mm of the deflection are due to the heading and {:.1f} mm to the bevel. The null model, a needle without bevel "
      "with its own best heading, has an RMS error of {:.2f} mm; the value must be smaller. The four recordings agree "
      "within half a millimetre, so the row tests little more than the shape. Needle and tissue have default values, "
      "because the recordings state neither gauge nor material.",
      fit.bevel_deg, std::atan(fit.heading) * 180.0 / std::numbers::pi, fit.rms_mm, ends, fit.heading * kDeepest_mm,
      fit.lateral_mm.back() - fit.heading * kDeepest_mm, unbevelled);
  finding.why_missed =
      "Gauge, bevel and material of the recordings are not known, and the model has only two fitted values.";
  Curve model{.label = "fitted", .x = fitted.front().depth_mm, .y = fit.lateral_mm};
  finding.plot = {.x_label = "depth [mm]", .y_label = "lateral position of the tip [mm]", .curves = {model}};
  for (const auto* set : {&fitted, &others}) {
    for (const TipRecording& r : *set) {
      finding.plot.curves.push_back({.label = r.name + (set == &fitted ? ", used for the fit" : ", predicted"),
                                     .x = r.depth_mm,
                                     .y = r.lateral_mm,
                                     .kind = set == &fitted ? Curve::Kind::points : Curve::Kind::reference});
    }
  }
  return finding;
}

}  // namespace

std::vector<RowSpec> tip_tracking_rows() {
  return {{"tip_tracking", Group::measurements,
           "The deflection of unsteered bevelled needles is predicted after a fit to two other recordings",
           "tracked tips, Bernardes et al. 2023; Chentanez et al. 2009 reached 0.75 mm in the gel of their fit", "mm",
           Accepted::at_most(0.75), false, predict}};
}

}  // namespace stylet::validate
