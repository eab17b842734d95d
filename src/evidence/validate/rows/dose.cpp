// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the dose of sources with analysis, with an independent calculator and with a planning system.
#include "../rows.hpp"
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/rate_table.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

namespace stylet::validate {

namespace {

constexpr const char* kPlan = "dose_synthetic/expected_synthetic.json";
constexpr const char* kMarginPlan = "dose_synthetic/margin_plan.json";
constexpr const char* kPhantomPlan = "robustbrachy_hdr_phantom/PL001.dcm";
constexpr const char* kPhantomDose = "robustbrachy_hdr_phantom/DO001.dcm";
constexpr double kTableError_percent = 0.05;
constexpr double kI125_days = 59.4;  ///< half-life that the calculator used [d]

/// A structure with the outline of an ellipsoid around the origin, drawn on planes 1 mm apart.
Roi ellipsoid(const Vec3& half) {
  Roi roi;
  roi.name = "prostate";
  const double last = std::floor(half.z() - 0.5) + 0.5;
  for (double z = -last; z <= last; z += 1.0) {
    const double scale = std::sqrt(1.0 - z * z / (half.z() * half.z()));
    Contour contour;
    for (int k = 0; k < 240; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 240;
      contour.points.emplace_back(scale * half.x() * std::cos(angle), scale * half.y() * std::sin(angle), z);
    }
    roi.contours.push_back(std::move(contour));
  }
  return roi;
}

Vec3 vector_of(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

/// The plan of 44 seeds with everything that the independent calculator found.
struct SyntheticPlan {
  nlohmann::json file;
  std::vector<PlacedSource> seeds;
  SourceModel source;
};

SyntheticPlan read_synthetic_plan(const std::filesystem::path& path) {
  SyntheticPlan plan;
  plan.file = nlohmann::json::parse(std::ifstream(path));
  auto source = need(find_source(plan.file.at("source").get<std::string>()));
  plan.source = std::move(source);
  for (const nlohmann::json& at : plan.file.at("seeds_xyz_mm"))
    plan.seeds.push_back({.at_mm = vector_of(at), .axis = Vec3::UnitZ(), .weight = plan.file.at("S_K_U")});
  return plan;
}

/// Compares the geometry function of a line source with the integral of 1/r² along it.
Finding line_geometry_is_an_integral(Context&) {
  constexpr double kLength = 3.0;
  Finding finding{.value = 0.0};
  finding.plot = {.x_label = "distance [mm]", .y_label = "r² G", .curves = {}};
  for (const double degrees : {1.0, 10.0, 30.0, 60.0, 90.0}) {
    const double cosine = std::cos(degrees * std::numbers::pi / 180.0);
    const double sine = std::sin(degrees * std::numbers::pi / 180.0);
    Curve ours{.label = fmt::format("{:g}°", degrees)};
    for (double r = 2.0; r <= 50.0; r *= 1.05) {
      // Simpson's rule; the integrand is smooth at this distance.
      constexpr int kParts = 2000;
      double sum = 0.0;
      for (int k = 0; k <= kParts; ++k) {
        const double z = kLength * (static_cast<double>(k) / kParts - 0.5);
        const double square = std::pow(r * cosine - z, 2) + std::pow(r * sine, 2);
        sum += (k == 0 || k == kParts ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0)) / square;
      }
      const double exact = sum / (3.0 * kParts);
      const double found = line_geometry(r, cosine, kLength);
      finding.value = worse(finding.value, 100.0 * std::abs(found / exact - 1.0));
      ours.add(r, r * r * found);
    }
    finding.plot.curves.push_back(std::move(ours));
  }
  finding.plot.curves.push_back(
      {.label = "point source", .x = {2.0, 50.0}, .y = {1.0, 1.0}, .kind = Curve::Kind::reference});
  finding.note = "A line source of 3 mm, from 2 to 50 mm, at five angles to its axis. The value is the largest error.";
  return finding;
}

/// Compares the DVH of an ellipsoid's samples with a dose that has a closed form: it falls linearly from the centre to
/// the surface of concentric ellipsoids, so the volume within each dose is known.
Finding dose_volume_of_an_ellipsoid(Context&) {
  const Vec3 half(25.0, 18.0, 21.0);
  const auto samples = need(sample_structure(ellipsoid(half), 1.0));
  std::vector<double> dose;
  for (const Vec3& x : samples.points) dose.push_back(100.0 * (2.0 - x.cwiseQuotient(half).norm()));
  const DoseVolume dvh(dose, samples.volume_mm3);
  Finding finding{.value = 0.0};
  Curve ours{.label = "samples"};
  Curve theory{.label = "ellipsoid", .kind = Curve::Kind::reference};
  for (int percent = 2; percent <= 98; percent += 2) {
    const double exact = 100.0 * (2.0 - std::cbrt(percent / 100.0));
    const double found = dvh.dose_of_percent(percent);
    finding.value = worse(finding.value, 100.0 * std::abs(found / exact - 1.0));
    ours.add(percent, found);
    theory.add(percent, exact);
  }
  const double volume = 4.0 / 3.0 * std::numbers::pi * half.prod() / 1000.0;
  finding.value = worse(finding.value, 100.0 * std::abs(dvh.volume_cc() / volume - 1.0));
  finding.plot = {.x_label = "share of the volume [%]", .y_label = "least dose [Gy]", .curves = {ours, theory}};
  finding.note = fmt::format(
      "An ellipsoid of {:.2f} cc, drawn on planes 1 mm apart and sampled every millimetre, with a dose that falls "
      "linearly from the centre of concentric ellipsoids. The value is the largest error of 49 doses of D2 to D98 and "
      "of the volume ({:.3f} cc).",
      volume, dvh.volume_cc());
  return finding;
}

/// Compares the table, which computes the dose of many points, with the formula for all shipped sources.
Finding table_of_the_formula(Context&) {
  Finding finding{.value = 0.0};
  finding.plot = {.x_label = "distance [mm]", .y_label = "largest error [%]", .log_y = true, .curves = {}};
  for (const SourceModel& source : known_sources()) {
    const auto formula = need(Tg43::create(source, DoseFormalism::line2d));
    const RateTable table(formula);
    Curve curve{.label = source.name};
    for (double r = RateTable::kNear_mm; r < 120.0; r *= 1.013) {
      double worst = 0.0;
      for (double cosine = -1.0; cosine <= 1.0; cosine += 0.0037)
        worst = worse(worst, 100.0 * std::abs(table.rate(r, cosine) / formula.rate(r, cosine) - 1.0));
      finding.value = worse(finding.value, worst);
      curve.add(r, worst);
    }
    finding.plot.curves.push_back(std::move(curve));
  }
  finding.plot.band = Accepted::at_most(kTableError_percent);
  finding.note =
      "All shipped sources from 4 to 120 mm; nearer than 4 mm the formula itself is used. The value is the largest "
      "error.";
  return finding;
}

Finding points_of_the_calculator(Context& context) {
  const auto path = need_file(context, kPlan);
  const auto plan = read_synthetic_plan(path);
  const auto tg43 = need(Tg43::create(plan.source, DoseFormalism::line2d));
  Finding finding{.value = 0.0};
  std::vector<std::pair<double, double>> errors;
  for (const nlohmann::json& point : plan.file.at("points")) {
    const Vec3 x = vector_of(point.at("xyz_mm"));
    double nearest = 1e300;
    for (const PlacedSource& seed : plan.seeds) nearest = std::min(nearest, (x - seed.at_mm).norm());
    if (nearest < 2.5) continue;
    double rate = 0.0;
    sum_rates(tg43, plan.seeds, {&x, 1}, {&rate, 1});
    const double dose = rate * permanent_Gy_per_rate(kI125_days);
    const double error = 100.0 * std::abs(dose / point.at("2d").get<double>() - 1.0);
    finding.value = worse(finding.value, error);
    errors.emplace_back(nearest, error);
  }
  std::sort(errors.begin(), errors.end());
  Curve curve{.label = "points", .kind = Curve::Kind::points};
  for (const auto& [distance, error] : errors) curve.add(distance, error);
  finding.plot = {.x_label = "distance from the nearest seed [mm]", .y_label = "error [%]", .curves = {curve}};
  finding.note =
      fmt::format("Total dose of 44 I-125 seeds at {} points further than 2.5 mm from all seeds.", errors.size());
  return finding;
}

Finding dose_volume_of_the_calculator(Context& context) {
  const auto path = need_file(context, kPlan);
  const auto plan = read_synthetic_plan(path);
  auto tg43 = need(Tg43::create(plan.source, DoseFormalism::line2d));
  const auto samples = need(sample_structure(ellipsoid(vector_of(plan.file.at("ellipsoid_semi_axes_mm"))), 0.5));
  std::vector<double> dose(samples.points.size());
  sum_rates(RateTable(std::move(tg43)), plan.seeds, samples.points, dose);
  for (double& d : dose) d *= permanent_Gy_per_rate(kI125_days);
  const DoseVolume dvh(dose, samples.volume_mm3);
  const nlohmann::json& expected = plan.file.at("structures").at("prostate_0.5mm").at("2d");
  const double prescription = plan.file.at("prescription_Gy");
  Finding finding{.value = 0.0};
  const auto compare = [&](double found, double wanted, bool relative) {
    finding.value = worse(finding.value, relative ? 100.0 * std::abs(found / wanted - 1.0) : std::abs(found - wanted));
  };
  compare(dvh.volume_cc(), expected.at("volume_cc"), true);
  compare(dvh.dose_of_percent(90.0), expected.at("D90_Gy"), true);
  compare(dvh.dose_of_percent(50.0), expected.at("D50_Gy"), true);
  compare(dvh.percent_above(prescription), expected.at("V100_pct"), false);
  compare(dvh.percent_above(1.5 * prescription), expected.at("V150_pct"), false);
  compare(dvh.percent_above(2.0 * prescription), expected.at("V200_pct"), false);
  Curve ours{.label = "stylet"};
  for (double gray = 40.0; gray <= 400.0; gray += 2.0) ours.add(gray, dvh.percent_above(gray));
  Curve theirs{.label = "calculator", .kind = Curve::Kind::points};
  theirs.add(expected.at("D90_Gy"), 90.0);
  theirs.add(prescription, expected.at("V100_pct"));
  theirs.add(expected.at("D50_Gy"), 50.0);
  theirs.add(1.5 * prescription, expected.at("V150_pct"));
  theirs.add(2.0 * prescription, expected.at("V200_pct"));
  finding.plot = {.x_label = "dose [Gy]", .y_label = "share of the volume [%]", .curves = {ours, theirs}};
  finding.note = fmt::format(
      "44 I-125 seeds in an ellipsoid of 40 cc, sampled every 0.5 mm. D90 is {:.2f} Gy (calculator: {:.2f} Gy), V100 "
      "{:.2f} % ({:.2f} %). The value is the largest difference of volume, D90 and D50 in per cent, and of V100, V150 "
      "and V200 in percentage points.",
      dvh.dose_of_percent(90.0), expected.at("D90_Gy").get<double>(), dvh.percent_above(prescription),
      expected.at("V100_pct").get<double>());
  return finding;
}

/// D90 over that of the plan when seeds land beside their places.
class Misplaced {
 public:
  Misplaced(const RateTable& table, StructureSamples samples, std::vector<PlacedSource> seeds)
      : table_(table), samples_(std::move(samples)), seeds_(std::move(seeds)), dose_(samples_.points.size()) {
    planned_ = D90(seeds_);
  }

  /// Mean over draws of the errors from a normal distribution. @param sigma standard deviations [mm]
  double random(const Vec3& sigma, int draws) {
    std::mt19937 engine(12);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<PlacedSource> placed = seeds_;
      for (PlacedSource& seed : placed) {
        for (int axis = 0; axis < 3; ++axis) seed.at_mm[axis] += sigma[axis] * normal(engine);
      }
      sum += D90(placed) / planned_;
    }
    return sum / draws;
  }

 private:
  double D90(const std::vector<PlacedSource>& placed) {
    sum_rates(table_, placed, samples_.points, dose_);
    return DoseVolume(dose_, samples_.volume_mm3).dose_of_percent(90.0);
  }

  const RateTable& table_;
  StructureSamples samples_;
  std::vector<PlacedSource> seeds_;
  std::vector<double> dose_;
  double planned_ = 0.0;
};

Finding errors_of_placement(Context& context) {
  const auto path = need_file(context, kPlan);
  const auto margin_path = need_file(context, kMarginPlan);
  const auto plan = read_synthetic_plan(path);
  auto tg43 = need(Tg43::create(plan.source, DoseFormalism::line1d));
  const RateTable table(std::move(tg43));
  const auto samples = need(sample_structure(ellipsoid(vector_of(plan.file.at("ellipsoid_semi_axes_mm"))), 1.5));
  const nlohmann::json margin = nlohmann::json::parse(std::ifstream(margin_path));
  std::vector<PlacedSource> margin_seeds;
  for (const nlohmann::json& at : margin.at("seeds"))
    margin_seeds.push_back({.at_mm = vector_of(at), .axis = Vec3::UnitZ(), .weight = margin.at("S_K")});
  Misplaced within(table, samples, plan.seeds);
  Misplaced beyond(table, samples, margin_seeds);
  constexpr int kDraws = 200;
  Finding finding{.value = 0.0};
  Curve ours_within{.label = "seeds within the gland"};
  Curve ours_beyond{.label = "seeds to 3 mm around it"};
  Curve theirs{.label = "calculator", .kind = Curve::Kind::points};
  for (int sigma = 1; sigma <= 6; ++sigma) {
    const double a = within.random(Vec3::Constant(sigma), kDraws);
    const double b = beyond.random(Vec3::Constant(sigma), kDraws);
    const double wanted_a =
        plan.file.at("placement_error_to_D90").at(fmt::format("iso_{}mm", sigma)).at("D90_ratio_mean");
    const double wanted_b = margin.at("curve").at(fmt::format("{}mm", sigma)).at(0);
    finding.value = std::max({finding.value, std::abs(a - wanted_a), std::abs(b - wanted_b)});
    ours_within.add(sigma, a);
    ours_beyond.add(sigma, b);
    theirs.add(sigma, wanted_a);
    theirs.add(sigma, wanted_b);
  }
  finding.plot = {.x_label = "standard deviation of the error on each axis [mm]",
                  .y_label = "D90 over that of the plan",
                  .curves = {ours_within, ours_beyond, theirs}};
  finding.note = fmt::format(
      "Seeds that land at random beside their places, with 1 to 6 mm on each axis: means of {} draws for a plan with "
      "44 seeds within the gland and one with 92 seeds that reach 3 mm beyond it. The value is the largest difference.",
      kDraws);
  return finding;
}

/// Compares the dose of a plan for a phantom with that of the planning system.
Finding dose_of_a_planning_system(Context& context) {
  const auto plan_path = need_file(context, kPhantomPlan);
  const auto dose_path = need_file(context, kPhantomDose);
  const auto plan = need(read_plan(plan_path));
  const auto grid = need(read_rtdose(dose_path));
  const auto source = need(find_source("ir192_gammamed_plus"));
  // The grid of the evaluation itself is not used here.
  const DoseOptions options{.grid_step_mm = 5.0, .goals = {}, .points = {}};
  auto evaluation = need(evaluate_dose(plan, source, {}, options));
  need(compare_with_grid(evaluation, grid, {}, options, Vec3(0, 0, -1)));
  const DoseComparison& found = *evaluation.comparison;
  Finding finding{.value = 0.0};
  for (const double ratio : {found.p1, found.median_ratio, found.p99})
    finding.value = worse(finding.value, 100.0 * std::abs(ratio - 1.0));
  finding.note = fmt::format(
      "An HDR plan with {} dwell positions, compared at {} points of the dose grid further than 4 mm from all of them: "
      "the ratio of the doses has the median {:.4f} and lies between {:.4f} and {:.4f} for 98 % of the points. The "
      "frames of the file lie 1 mm lower than its header says. The value is the largest of the three errors.",
      plan.sources.size(), found.points, found.median_ratio, found.p1, found.p99);
  return finding;
}

}  // namespace

std::vector<RowSpec> dose_rows() {
  return {
      {"dose_line_geometry", Group::analysis, "The geometry function of a line source is the integral along it",
       "integral of 1/r² by Simpson’s rule; TG-43U1, Rivard et al. 2004", "%", Accepted::at_most(1e-6), true,
       line_geometry_is_an_integral},
      {"dose_volume_ellipsoid", Group::analysis, "Dose–volume figures of a contoured ellipsoid are those of the solid",
       "volume of concentric ellipsoids", "%", Accepted::at_most(0.3), true, dose_volume_of_an_ellipsoid},
      {"dose_points", Group::other_code, "The dose of a plan of 44 seeds is that of an independent calculator",
       "independent TG-43 calculator, 2D line source", "%", Accepted::at_most(0.05), true, points_of_the_calculator},
      {"dose_volume_figures", Group::other_code,
       "Volume, D90, D50, V100, V150 and V200 are those of an independent calculator",
       "independent TG-43 calculator, sampled every 0.5 mm", "%", Accepted::at_most(0.3), true,
       dose_volume_of_the_calculator},
      {"dose_placement_error", Group::other_code,
       "D90 falls with random errors of the seeds’ places as an independent calculator says",
       "independent TG-43 calculator, 1D line source", "", Accepted::at_most(0.01), false, errors_of_placement},
      {"dose_planning_system", Group::other_code, "The dose of an HDR plan is that of the planning system",
       "planning system; Kennedy et al. 2023", "%", Accepted::at_most(0.5), false, dose_of_a_planning_system},
      {"dose_table", Group::independence, "The table for many points is as exact as the formula", "Tg43::rate()", "%",
       Accepted::at_most(kTableError_percent), true, table_of_the_formula},
  };
}

}  // namespace stylet::validate
