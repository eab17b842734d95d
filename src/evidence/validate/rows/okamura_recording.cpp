// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the shape of the force over depth with a recorded insertion into liver.
#include "../number_table.hpp"
#include "../rows.hpp"
#include "../scene.hpp"
#include "published_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

namespace stylet::validate {

namespace {

using namespace published;

constexpr const char* kFile = "force_okamura_insertion/depth_force.csv";
constexpr double kBin_mm = 1.0;
constexpr double kSoftest_kPa = 2.0;
constexpr double kStiffest_kPa = 400.0;
constexpr double kContact_N = 0.15;  ///< larger than the noise before contact

/// The recording as mean forces in bins of depth; the depth is measured from the contact.
struct OkamuraRecording {
  std::vector<double> depth_mm;
  std::vector<double> force_N;
  double first_peak_N = 0.0;  ///< largest force before the first drop
  double first_peak_mm = 0.0;
  double contact_mm = 0.0;  ///< depth of the contact on the recording's own scale
};

OkamuraRecording read_recording_of(const std::filesystem::path& file) {
  const auto columns = need(read_number_table(file));
  if (columns.size() < 2)
    throw Failed{input_error(file.string(), "there are fewer than two columns", "Use the file as it was published")};
  const auto& depth = columns[0];
  const auto& force = columns[1];
  const double most = *std::max_element(depth.begin(), depth.end());
  // The points are not sorted and several forces have the same depth, so they are averaged in bins.
  const auto bins = static_cast<std::size_t>(1e3 * most / kBin_mm) + 1;
  std::vector<double> sum(bins, 0.0);
  std::vector<int> count(bins, 0);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const auto bin = static_cast<std::size_t>(std::max(0.0, 1e3 * depth[i]) / kBin_mm);  // metres
    sum[bin] += force[i];
    ++count[bin];
  }
  OkamuraRecording out;
  for (std::size_t b = 0; b < bins; ++b) {
    if (count[b] == 0) continue;
    const double f = sum[b] / count[b];
    const double z = (static_cast<double>(b) + 0.5) * kBin_mm;
    if (out.depth_mm.empty() && f < kContact_N) {
      out.contact_mm = z;
      continue;
    }
    out.depth_mm.push_back(z - out.contact_mm);
    out.force_N.push_back(f);
  }
  // The first peak is the largest force before the force falls to half of it for the first time.
  for (std::size_t i = 0; i < out.force_N.size(); ++i) {
    if (out.force_N[i] > out.first_peak_N) {
      out.first_peak_N = out.force_N[i];
      out.first_peak_mm = out.depth_mm[i];
    } else if (out.force_N[i] < 0.5 * out.first_peak_N) {
      break;
    }
  }
  if (out.force_N.size() < 10)
    throw Failed{input_error(file.string(), "the force does not rise", "Use the file as it was published")};
  return out;
}

/// Simulates the insertion with published parameters and the two fitted ones.
Curve simulate(double young_kPa, double puncture_N, double depth_mm) {
  Block block = Block::of_one_tissue(TissuePreset::linear);
  TissueParameters& tissue = block.tissue("body");
  tissue.young_kPa = young_kPa;
  tissue.puncture_N = puncture_N;
  tissue.cutting_N = okamura::kCutting.mean;
  tissue.friction_static_N_per_m = okamura::kStatic_N_per_m;
  tissue.friction_coulomb_N_per_m = okamura::kCoulomb_N_per_m;
  tissue.friction_viscous_Ns_per_m2 = okamura::kViscous_Ns_per_m2;
  Drive drive(need(block.compile()), 0.0);
  drive.go(depth_mm, okamura::kSpeed_mm_per_s, 10e-3);
  return curve_of(drive, "simulated");
}

double rms(const OkamuraRecording& recording, const Curve& curve) {
  double sum = 0.0;
  for (std::size_t i = 0; i < recording.depth_mm.size(); ++i)
    sum += std::pow(interpolated(curve.x, curve.y, recording.depth_mm[i]) - recording.force_N[i], 2);
  return std::sqrt(sum / static_cast<double>(recording.depth_mm.size()));
}

Finding force_over_depth(Context& context) {
  const auto recording = read_recording_of(need_file(context, kFile));
  // The puncture force is taken from the recording. The logarithm of the modulus is fitted.
  const auto simulated = [&](double log_kPa) {
    return simulate(std::exp(log_kPa), recording.first_peak_N, recording.depth_mm.back());
  };
  const auto rms_at = [&](double log_kPa) { return rms(recording, simulated(log_kPa)); };
  const auto [best_log_kPa, best_rms] =
      boost::math::tools::brent_find_minima(rms_at, std::log(kSoftest_kPa), std::log(kStiffest_kPa), 12);
  const auto best = simulated(best_log_kPa);
  const double best_kPa = std::exp(best_log_kPa);
  const double peak = *std::max_element(recording.force_N.begin(), recording.force_N.end());
  const double punch_kPa = okamura::modulus_kPa(Scenario{}.needle.diameter_mm, default_tissue("body").poisson);
  const bool plausible =
      std::abs(recording.first_peak_N - okamura::kPuncture.mean) <= 2.0 * okamura::kPuncture.deviation;
  const bool at_edge = best_kPa <= 1.05 * kSoftest_kPa || best_kPa >= 0.95 * kStiffest_kPa;
  Finding finding;
  finding.value = 100.0 * best_rms / peak;
  finding.note = fmt::format(
      "Fitted: puncture force {:.2f} N (study: 2.30 ± 0.83 N, {}) and modulus {:.0f} kPa{} (from the study’s stiffness "
      "and a flat punch: {:.0f} kPa). From the literature: cutting force 0.94 N, friction 18.5 and 10.6 N/m and "
      "212 N s/m². The value is the RMS difference, relative to the largest force of the recording.",
      recording.first_peak_N, plausible ? "within two standard deviations" : "outside two standard deviations",
      best_kPa, at_edge ? ", at the end of the searched range" : "", punch_kPa);
  finding.why_missed =
      "The recording shows two layers, each with a membrane: the force falls to 0.2 N, below the cutting force of "
      "liver, and rises over 17 mm to a second puncture. The model has one layer here and its tissue does not stiffen. "
      "A second layer would need more than two fitted values.";
  finding.plot = {
      .x_label = "depth from contact [mm]",
      .y_label = "axial force [N]",
      .curves = {best,
                 {.label = "recorded", .x = recording.depth_mm, .y = recording.force_N, .kind = Curve::Kind::points}}};
  return finding;
}

}  // namespace

std::vector<RowSpec> okamura_recording_rows() {
  return {
      {"liver_recording", Group::measurements, "The force over depth has the shape of a recorded insertion into liver",
       "recording of Okamura et al. 2004, digitised", "% of peak", Accepted::at_most(15.0), false, force_over_depth}};
}

}  // namespace stylet::validate
