// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the default values with measurements in patients and cadavers, for the demo and for a gland drawn as a mask.
#include "../patients.hpp"
#include "../rows.hpp"
#include "published_values.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace stylet::validate {

namespace {

using namespace published;

constexpr double kUsual_mm_per_s = 20.0;
constexpr double kSlow_mm_per_s = 5.0;
constexpr double kFast_mm_per_s = 150.0;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Measure = Finding (*)(Context&, Patients&, PatientCase);

/// The gland's shift when its surface breaks; empty if it does not break.
std::optional<Vec3> shift_at_break(const RecordedRun& run) {
  return run.summary.gland ? run.summary.gland->shift_at_break_mm : std::nullopt;
}

double norm_at_break(const RecordedRun& run) {
  const auto shift = shift_at_break(run);
  return shift ? shift->norm() : kNone;
}

/// The puncture of the skin, which is the first puncture of a run; null if there is none.
const Event* skin_break(const RecordedRun& run) { return run.event(EventKind::puncture); }

Plot force_plot(const RecordedRun& run) {
  Curve in{.label = "on the way in"};
  for (const Step& s : run.steps) {
    if (in.x.empty() || s.base_depth_mm > in.x.back()) in.add(s.base_depth_mm, s.force_axial_N);
  }
  return {.x_label = "base depth [mm]", .y_label = "axial force [N]", .curves = {in}};
}

Plot path_plot(const RecordedRun& run) {
  std::array<Curve, 3> axes{Curve{.label = "to the left"}, Curve{.label = "to posterior"},
                            Curve{.label = "to superior"}};
  for (const GlandStep& s : run.summary.gland_path) {
    if (!axes[0].x.empty() && s.base_depth_mm <= axes[0].x.back()) continue;
    for (int a = 0; a < 3; ++a) axes[static_cast<std::size_t>(a)].add(s.base_depth_mm, s.shift_mm[a]);
  }
  return {.x_label = "base depth [mm]", .y_label = "shift of the gland [mm]", .curves = {axes[0], axes[1], axes[2]}};
}

Finding gland_shift(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  const auto slow = patients.run(context, patient, {.speed_mm_per_s = kSlow_mm_per_s});
  Finding finding;
  finding.value = norm_at_break(*run);
  finding.note = fmt::format(
      "The value is the mean shift of the gland’s volume when its surface breaks, at {:g} mm/s; it is {:.2f} mm at "
      "{:g} mm/s. Published: {:g} mm (0.3 … 21.6) for a needle that is pushed (not verified), 5.2 mm for the targets "
      "of 90 guided cores. The null model, a rigid gland, gives 0 mm.",
      kUsual_mm_per_s, norm_at_break(*slow), kSlow_mm_per_s, prostate::kPushedShift_mm);
  finding.plot = path_plot(*run);
  return finding;
}

Finding gland_turn(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  Finding finding;
  if (!run->summary.gland) return finding;
  const PlaneAngles turn = plane_angles(run->summary.gland->rotation_deg);
  finding.value = std::abs(turn.coronal);
  finding.note = fmt::format(
      "The value is the turn in the coronal plane by a needle 15 mm to the left of the axis; the turn is {:.1f}° in "
      "the sagittal and {:.1f}° in the transverse plane. Published: up to about 14° (Lagerburg 2005, not verified). "
      "The null model, a rigid gland, gives 0°.",
      turn.sagittal, turn.transverse);
  return finding;
}

Finding peak_force(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  Finding finding;
  finding.value = run->summary.peak_axial_N;
  finding.note =
      "Published for 18 gauge: about 8.9 N through the perineum and 6 N in the gland (Podder 2006, not verified). The "
      "default puncture force of the capsule was fitted to these values.";
  finding.plot = force_plot(*run);
  return finding;
}

Finding skin_force(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  Finding finding;
  if (const Event* skin = skin_break(*run)) finding.value = skin->force_N;
  finding.note =
      "The value is the force of the hand when the skin breaks. Published: 2.75 … 2.80 N in fresh cadaver, from which "
      "the default puncture force of the skin is taken.";
  return finding;
}

Finding skin_dent(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  const auto slow = patients.run(context, patient, {.speed_mm_per_s = kSlow_mm_per_s});
  const auto dent = [](const RecordedRun& r) {
    const Event* contact = r.event(EventKind::skin_contact);
    const Event* skin = skin_break(r);
    return contact != nullptr && skin != nullptr ? skin->depth_mm - contact->depth_mm : kNone;
  };
  Finding finding;
  finding.value = std::max(dent(*run), dent(*slow));
  finding.note = fmt::format(
      "The base moves by {:.1f} mm at {:g} mm/s, and by {:.1f} mm at {:g} mm/s, from the contact with the skin to its "
      "puncture. No measurement at the perineum is known; up to 12 mm is considered plausible.",
      dent(*run), kUsual_mm_per_s, dent(*slow), kSlow_mm_per_s);
  return finding;
}

Finding force_slope(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  Finding finding;
  const Event* skin = skin_break(*run);
  if (skin == nullptr) return finding;
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, deepest = skin->depth_mm;
  for (const Step& s : run->steps) {
    if (s.base_depth_mm <= deepest) continue;
    deepest = s.base_depth_mm;
    n += 1;
    sx += s.base_depth_mm;
    sy += s.force_axial_N;
    sxx += s.base_depth_mm * s.base_depth_mm;
    sxy += s.base_depth_mm * s.force_axial_N;
  }
  if (n > 10) finding.value = 1e3 * (n * sxy - sx * sy) / (n * sxx - sx * sx);
  finding.note =
      "The value is the slope of a straight line that is fitted to the force over depth, from the puncture of the skin "
      "to the deepest point. Published: 35 … 59 N/m in fresh cadaver.";
  finding.plot = force_plot(*run);
  return finding;
}

Finding gland_seat(Context& context, Patients& patients, PatientCase patient) {
  const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s});
  const double at_once = seat_N_per_mm(*run->model);
  const double creep = creep_of(run->model->scenario());
  Finding finding;
  finding.value = at_once / creep;
  finding.note = fmt::format(
      "The value is a lasting force along the patient’s axis, spread evenly over the gland, divided by the gland’s "
      "mean displacement. Without creep it is {:.2f} N/mm; creep reduces it to 1/{:g}. Derived from published forces "
      "and shifts: 0.7 … 1.4 N/mm. The null model, a rigid gland, has no displacement.",
      at_once, creep);
  return finding;
}

Finding speed_ratio(Context& context, Patients& patients, PatientCase patient) {
  Finding finding;
  Curve creeping{.label = "default tissue"};
  Curve elastic{.label = "null model: without creep", .kind = Curve::Kind::reference};
  for (const double speed : {kSlow_mm_per_s, kUsual_mm_per_s, kFast_mm_per_s}) {
    const auto run = patients.run(context, patient, {.speed_mm_per_s = speed});
    creeping.add(speed, norm_at_break(*run));
    const auto null = patients.run(context, patient, {.speed_mm_per_s = speed, .creeps = false});
    elastic.add(speed, norm_at_break(*null));
  }
  const double ratio = creeping.y.back() / creeping.y.front();
  const double null = elastic.y.back() / elastic.y.front();
  const bool counts = creeping.y.front() > 1.0 && ratio < null;
  finding.value = counts ? ratio : kNone;
  finding.note = fmt::format(
      "The shift of the gland when its surface breaks is {:.2f} mm at {:g} mm/s and {:.2f} mm at {:g} mm/s, a ratio of "
      "{:.2f}; the first must be more than 1 mm. Published: {:g} mm with a tapped needle and {:g} mm with a pushed "
      "one, at second hand and NOT VERIFIED. McLaughlin et al. (AAPM 2022) report that high-speed placement moved a "
      "phantom, built to be movable, by up to {:g} mm, and a pneumatic device by {:g} mm; they give no value for slow "
      "needles. The null model, tissue without creep, gives a ratio of {:.2f}; the value must be smaller.",
      creeping.y.front(), kSlow_mm_per_s, creeping.y.back(), kFast_mm_per_s, ratio, prostate::kTappedShift_mm,
      prostate::kPushedShift_mm, prostate::kPhantomHighSpeed_mm, prostate::kPhantomPneumatic_mm, null);
  finding.why_missed =
      "The model has neither inertia nor a cutting force that decreases with speed. Only creep makes a fast needle "
      "move the gland less.";
  finding.plot = {
      .x_label = "speed [mm/s]", .y_label = "shift of the gland [mm]", .log_x = true, .curves = {creeping, elastic}};
  return finding;
}

Finding axis_ratio(Context& context, Patients& patients, PatientCase patient) {
  const std::array<const char*, 6> holes{"c3.5", "e3.5", "c4.5", "e4.5", "D3", "d5"};
  Vec3 mean = Vec3::Zero();
  std::array<Curve, 3> curves{Curve{.label = "left or right", .kind = Curve::Kind::points},
                              Curve{.label = "anterior or posterior", .kind = Curve::Kind::points},
                              Curve{.label = "along the needle", .kind = Curve::Kind::points}};
  for (std::size_t k = 0; k < holes.size(); ++k) {
    const auto run = patients.run(context, patient, {.speed_mm_per_s = kUsual_mm_per_s, .hole = holes[k]});
    if (!run->summary.gland) return Finding{.note = "The patient has no gland."};
    const Vec3 shift = run->summary.gland->shift_max_mm.cwiseAbs();
    mean += shift / static_cast<double>(holes.size());
    for (int a = 0; a < 3; ++a) curves[static_cast<std::size_t>(a)].add(static_cast<double>(k + 1), shift[a]);
  }
  const double over_left = mean.z() / mean.x();
  const double over_posterior = mean.z() / mean.y();
  // The worse of the two ratios is the one that is further from the middle of the accepted range.
  const auto off = [](double ratio) { return std::abs(std::log(ratio / std::sqrt(1.5 * 8.0))); };
  const double further = off(over_left) > off(over_posterior) ? over_left : over_posterior;
  Finding finding;
  finding.value = mean.z() >= 2.0 ? further : kNone;
  finding.note = fmt::format(
      "The mean of the largest shift over the holes {} is {:.2f} mm along the needle. This is {:.1f} times the shift "
      "to the left or right and {:.1f} times the shift to anterior or posterior. The worse of the two ratios counts, "
      "and the shift along the needle must be at least 2 mm. Seeds were misplaced by {:g}, {:g} and {:g} cm on "
      "average, by other causes too. The null model, a rigid gland, has no ratio.",
      fmt::join(holes, ", "), mean.z(), over_left, over_posterior, prostate::kSeedX_cm, prostate::kSeedY_cm,
      prostate::kSeedZ_cm);
  finding.why_missed =
      "A needle through a template is parallel to the patient’s axis, and the tissue around the gland is nearly the "
      "same on all sides, so only a small part of the force acts across. These runs have no probe in the rectum, no "
      "needles that are not parallel, and none of the other causes of misplaced seeds.";
  finding.plot = {
      .x_label = "needle", .y_label = "shift of the gland [mm]", .curves = {curves[0], curves[1], curves[2]}};
  return finding;
}

Finding bevel_deflection(Context& context, Patients& patients, PatientCase patient) {
  constexpr double depth_mm = 95.0;
  const auto deflection_with = [&](double bevel_deg) {
    const PatientRun how{.speed_mm_per_s = kUsual_mm_per_s, .depth_mm = depth_mm, .bevel_deg = bevel_deg};
    return patients.run(context, patient, how)->summary.tip_deflection_mm;
  };
  const double deflection = deflection_with(20.0), symmetric = deflection_with(0.0);
  Finding finding;
  finding.value = deflection > symmetric ? deflection : kNone;
  finding.note = fmt::format(
      "The value is the largest distance of the tip from the straight line at a depth of {:g} mm, with a bevel of 20° "
      "and a guide. The null model, a symmetric tip, gives {:.2f} mm, which must be less.",
      depth_mm, symmetric);
  return finding;
}

struct Claim {
  const char* id = nullptr;
  const char* claim = nullptr;
  const char* reference = nullptr;
  const char* unit = nullptr;
  Accepted accepted{};
  Measure measure = nullptr;
};

const Claim kClaims[] = {
    {"gland_shift", "a needle moves the gland by some millimetres before its surface breaks",
     "Lagerburg et al. 2006, 5.6 mm (0.3 … 21.6), NOT VERIFIED; 5.2 mm in 90 MR-guided cores", "mm",
     Accepted::between(2.0, 12.0), gland_shift},
    {"gland_turn", "a needle beside the axis turns the gland by some degrees",
     "Lagerburg et al. 2005, up to 14°, NOT VERIFIED", "°", Accepted::between(2.0, 15.0), gland_turn},
    {"peak_force", "the largest axial force is as in patients", "18 gauge, Podder et al. 2006, NOT VERIFIED", "N",
     Accepted::between(4.0, 10.0), peak_force},
    {"skin_force", "the skin breaks at the force measured in cadavers", "fresh cadaver, doi 10.1089/end.2016.0342", "N",
     Accepted::between(2.0, 3.5), skin_force},
    {"skin_dent", "the skin tents by a plausible depth at both speeds", "plausible range, not measured", "mm",
     Accepted::between(3.0, 12.0), skin_dent},
    {"force_slope", "the force grows with depth as in cadavers", "fresh cadaver, doi 10.1089/end.2016.0342", "N/m",
     Accepted::between(30.0, 70.0), force_slope},
    {"gland_seat", "the gland is held as softly as forces and shifts in patients suggest",
     "derived from published forces and shifts", "N/mm", Accepted::between(0.5, 2.0), gland_seat},
    {"speed_ratio", "a fast needle moves the gland far less than a slow one",
     "NOT VERIFIED: Lagerburg et al. 2006, 0.9 mm tapped / 5.6 mm pushed; up to 0.4 is accepted", "",
     Accepted::at_most(0.4), speed_ratio},
    {"axis_ratio", "the gland moves along the needle more than across it, but not only along it",
     "seed misplacement by axis, 1,197 seeds of 357 needles in 15 patients", "", Accepted::between(1.5, 8.0),
     axis_ratio},
    {"bevel_deflection", "a bevel deflects the needle by some millimetres", "range of tracked needles", "mm",
     Accepted::between(1.0, 7.0), bevel_deflection},
};

}  // namespace

std::vector<RowSpec> in_patients_rows() {
  const auto patients = std::make_shared<Patients>();
  std::vector<RowSpec> rows;
  for (const PatientCase patient : {PatientCase::demo, PatientCase::mask}) {
    for (const Claim& claim : kClaims) {
      const auto measure = [patients, patient, &claim](Context& context) -> Finding {
        if (!Patients::is_there(context, patient)) throw Skipped{context.no_data(Patients::kMask)};
        return claim.measure(context, *patients, patient);
      };
      const bool demo = patient == PatientCase::demo;
      rows.push_back({fmt::format("{}_{}", demo ? "demo" : "mask", claim.id), Group::measurements,
                      fmt::format("{}: {}", demo ? "Demo patient" : "A patient’s mask", claim.claim), claim.reference,
                      claim.unit, claim.accepted, false, measure});
    }
  }
  return rows;
}

}  // namespace stylet::validate
