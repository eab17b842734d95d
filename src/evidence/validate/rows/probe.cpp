// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the gland under a probe in the rectum with published changes of its size.
#include "../rows.hpp"
#include "published_values.hpp"

#include "stylet/measure/demo.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

namespace stylet::validate {

namespace {

using namespace published;

constexpr Index kProbeNodes = 5000;
constexpr double kBeyondMiddle_mm = 30.0;  // the rounded end lies beyond the gland's base, as that of a coil does
constexpr double kLiftStep_mm = 0.25;
constexpr double kMostLift_mm = 40.0;

/// The gland when the probe has flattened it by as much as a study found.
struct Flattened {
  double lift_mm = 0.0;
  Vec3 force_N = Vec3::Zero();
  GlandForm gland;
  Curve depth{.label = "anterior-posterior"};
  Curve width{.label = "left-right"};
  Curve length{.label = "superior-inferior"};
};

/// The gland of the demo patient under a bare probe and under a probe in a balloon, each found once for all rows.
class ProbeStudy {
 public:
  Flattened flatten(double to_percent, double balloon_mm) {
    const std::pair study(to_percent, balloon_mm);
    const auto known = found_.find(study);
    if (known != found_.end()) return known->second;
    return found_.emplace(study, find(to_percent, balloon_mm)).first->second;
  }

 private:
  Flattened find(double to_percent, double balloon_mm) {
    if (!demo_) {
      auto demo = need(measure::probed_demo(kProbeNodes));
      demo_ = std::make_unique<measure::ProbedDemo>(std::move(demo));
    }
    ProbeSettings at;
    at.kind = ProbeKind::biplane;
    at.balloon_mm = balloon_mm;
    const auto seat = need(probe_seat(demo_->tissue->mesh(), demo_->gland, "demo"));
    at.depth_mm = seat.gland_mm + kBeyondMiddle_mm;
    auto probe = need(PatientProbe::prepare(demo_->patient(), at, "demo"));
    Flattened found;
    for (at.lift_mm = -5.0; at.lift_mm <= kMostLift_mm; at.lift_mm += kLiftStep_mm) {
      found.force_N = probe.press(at).force_N;
      found.gland = probe.gland();
      found.lift_mm = at.lift_mm;
      found.depth.add(at.lift_mm, found.gland.change_percent.y());
      found.width.add(at.lift_mm, found.gland.change_percent.x());
      found.length.add(at.lift_mm, found.gland.change_percent.z());
      if (found.gland.change_percent.y() <= to_percent) return found;
    }
    throw Failed{failure("demo",
                         fmt::format("a lift of {:g} mm flattens the gland by {:.1f} % only", kMostLift_mm,
                                     -found.gland.change_percent.y()),
                         "Look at the wall that the probe reaches")};
  }

  std::unique_ptr<measure::ProbedDemo> demo_;
  std::map<std::pair<double, double>, Flattened> found_;  ///< by to_percent and balloon_mm
};

enum class Size { width, length, volume };

double change_of(const GlandForm& gland, Size size) {
  if (size == Size::volume) return gland.volume_percent;
  return size == Size::width ? gland.change_percent.x() : gland.change_percent.z();
}

Finding flattened_gland(ProbeStudy& study, double to_percent, double balloon_mm, Size size,
                        const std::string& published) {
  const auto found = study.flatten(to_percent, balloon_mm);
  const double creep = creep_of(Scenario{});
  Finding finding;
  finding.value = change_of(found.gland, size);
  finding.note = fmt::format(
      "A probe of {:g} mm radius, lifted by {:.2f} mm from the middle of the rectum with its end beyond the gland’s "
      "base, flattens the gland by {:.1f} %. It then bears {:.1f} N, or {:.1f} N once the tissue has crept. The gland "
      "is {:+.1f} % wider, {:+.1f} % longer and {:+.1f} % larger. {} The null model, no probe, gives 0 % throughout{}.",
      10.0 + balloon_mm, found.lift_mm, -found.gland.change_percent.y(), found.force_N.norm(),
      found.force_N.norm() / creep, found.gland.change_percent.x(), found.gland.change_percent.z(),
      found.gland.volume_percent, published,
      size == Size::length || balloon_mm > 0.0 ? ""
                                               : ", which is in the accepted range too, since patients differ much");
  finding.why_missed =
      "The tissue is linear, the contact has no friction, and the demo patient is not one of the study’s patients.";
  finding.plot = {.x_label = "lift of the probe [mm]",
                  .y_label = "change of the gland’s extent [%]",
                  .curves = {found.depth, found.width, found.length}};
  return finding;
}

Accepted within_deviation(const Measured& measured) {
  return Accepted::between(measured.mean - measured.deviation, measured.mean + measured.deviation);
}

}  // namespace

std::vector<RowSpec> probe_rows() {
  const auto study = std::make_shared<ProbeStudy>();
  constexpr double kBalloon_mm = 5.0;  // on a rod of 20 mm: 50 ml over a length of 70 mm have a radius of 15 mm
  const std::string coil = fmt::format(
      "Published for a coil in 79 patients, as mean and standard deviation: depth {:+g} ± {:g} %, width {:+g} ± {:g} "
      "%, "
      "length {:+g} ± {:g} %, volume {:+g} ± {:g} %.",
      osman::kDepth.mean, osman::kDepth.deviation, osman::kWidth.mean, osman::kWidth.deviation, osman::kLength.mean,
      osman::kLength.deviation, osman::kVolume.mean, osman::kVolume.deviation);
  const std::string balloon = fmt::format(
      "Published for a balloon of 50 ml in 44 patients, means only: depth {:+g} %, width {:+g} %, length {:+g} %. Half "
      "to one and a half times the mean is accepted.",
      -balloon50::kDepth_percent, balloon50::kWidth_percent, balloon50::kLength_percent);
  const auto row = [&](const char* id, const char* claim, const char* reference, Accepted accepted, double to_percent,
                       double balloon_mm, Size size, const std::string& published) {
    return RowSpec{id,    Group::measurements,
                   claim, reference,
                   "%",   accepted,
                   false, [=](Context&) { return flattened_gland(*study, to_percent, balloon_mm, size, published); }};
  };
  const auto half = [](double mean) { return Accepted::between(0.5 * mean, 1.5 * mean); };
  constexpr const char* kCoilSource = "endorectal coil, 79 patients, Osman et al. 2014, mean ± 1 standard deviation";
  constexpr const char* kBalloonSource = "endorectal balloon of 50 ml, 44 patients, NOT VERIFIED";
  return {
      row("probe_width", "a gland flattened as by a coil widens as in patients", kCoilSource,
          within_deviation(osman::kWidth), osman::kDepth.mean, 0.0, Size::width, coil),
      row("probe_length", "a gland flattened as by a coil lengthens as in patients", kCoilSource,
          within_deviation(osman::kLength), osman::kDepth.mean, 0.0, Size::length, coil),
      row("probe_volume", "a gland flattened as by a coil keeps its volume as in patients", kCoilSource,
          within_deviation(osman::kVolume), osman::kDepth.mean, 0.0, Size::volume, coil),
      row("balloon_width", "a gland flattened as by a balloon of 50 ml widens as in patients", kBalloonSource,
          half(balloon50::kWidth_percent), -balloon50::kDepth_percent, kBalloon_mm, Size::width, balloon),
      row("balloon_length", "a gland flattened as by a balloon of 50 ml lengthens as in patients", kBalloonSource,
          half(balloon50::kLength_percent), -balloon50::kDepth_percent, kBalloon_mm, Size::length, balloon),
  };
}

}  // namespace stylet::validate
