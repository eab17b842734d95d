// SPDX-License-Identifier: GPL-3.0-or-later
// Rules about how long the sources stay: type, technique, channels, times, total air kerma.
#include "dose/rules.hpp"

#include <algorithm>
#include <numbers>

namespace stylet::dose {

namespace {

constexpr double kDay_s = 86400.0, kHour_s = 3600.0;
constexpr double kLongestLowRate_s = 60.0 * kDay_s;

void judge_type(const Judged& judged, Findings& found) {
  const PlanSays& says = judged.plan.says;
  const bool high = says.type == "HDR" || says.type == "MDR" || says.type == "PDR";
  if (says.technique == "PERMANENT" && high) {
    found.refuse(Rule::type_and_technique, judged.plan.file,
                 fmt::format("the technique (300A,0200) is PERMANENT, and the type (300A,0202) is {}", says.type),
                 "Correct one of them in the planning system and export the plan again");
  }
  if (!says.is_dicom || judged.temporary()) return;
  if (!says.technique.empty() && says.technique != "PERMANENT") {
    found.warn(Rule::type_and_technique,
               fmt::format("The technique (300A,0200) is {}, and the sources are computed as staying until they have "
                           "decayed",
                           says.technique));
  }
  const double mean_life_s = judged.models.front().half_life_days * kDay_s / std::numbers::ln2;
  if (says.longest_channel_s > kHour_s && std::abs(says.longest_channel_s / mean_life_s - 1.0) > 0.1) {
    found.warn(Rule::type_and_technique,
               fmt::format("The sources are computed as staying until they have decayed, and the plan says a time of "
                           "{:.4g} d (300A,0286); the mean life of {} is {:.4g} d",
                           says.longest_channel_s / kDay_s, judged.models.front().isotope, mean_life_s / kDay_s));
  }
}

void judge_channel(const Judged& judged, const ChannelSays& channel, Findings& found) {
  if (channel.points_said > 0 && channel.points_said != channel.points) {
    found.warn(Rule::control_points, fmt::format("{}: it announces {} control points and has {}", channel.where,
                                                 channel.points_said, channel.points));
  }
  if (channel.shielded)
    found.warn(Rule::not_computed, fmt::format("{}: its shields (300A,02B0) are not computed", channel.where));
  if (!judged.temporary()) return;
  const bool has_time = std::isfinite(channel.total_s);
  if (channel.weights > 0.0 && !has_time) {
    found.refuse(Rule::channel_time, channel.where,
                 fmt::format("its places have the weights {:g}, and its time (ChannelTotalTime, 300A,0286) is missing",
                             channel.weights),
                 "Export the plan again with the time of this channel");
  } else if (channel.weights > 0.0 && channel.total_s == 0.0) {
    found.warn(Rule::channel_time, fmt::format("{}: its places have the weights {:g}, and its time is 0 s, so it gives "
                                               "no dose",
                                               channel.where, channel.weights));
  } else if (channel.weights <= 0.0 && has_time && channel.total_s > 0.0) {
    found.warn(Rule::channel_time,
               fmt::format("{}: it lasts {:g} s, and none of its places has a weight, so it gives no "
                           "dose",
                           channel.where, channel.total_s));
  }
  if (channel.weights > 0.0 && channel.final_weight > 0.0 && has_time &&
      std::abs(channel.weights / channel.final_weight - 1.0) > kSameWeights) {
    found.warn(
        Rule::channel_weights,
        fmt::format("{}: the weights of its places add up to {:g}, the final cumulative time weight is {:g}; the "
                    "channel's time of {:g} s is divided by the sum of the weights",
                    channel.where, channel.weights, channel.final_weight, channel.total_s));
  }
  const bool pulsed = judged.plan.says.type == "PDR";
  if (pulsed ? channel.pulses < 2 : channel.pulses > 1) {
    found.warn(Rule::pulses, pulsed ? fmt::format("{}: the plan is pulsed (PDR), and the channel has {} pulse",
                                                  channel.where, channel.pulses)
                                    : fmt::format("{}: it has {} pulses (300A,028A), which count in PDR plans only",
                                                  channel.where, channel.pulses));
  }
}

void judge_dwell_times(const Judged& judged, Findings& found) {
  const DosePlan& plan = judged.plan;
  if (plan.says.dwell_of_permanent_s > 0.0) {
    found.refuse(Rule::dwell_of_permanent, plan.file,
                 fmt::format("the sources have dwell times (dwell_s, {:g} s in all), and the implant is permanent",
                             plan.says.dwell_of_permanent_s),
                 "Write \"implant\": \"temporary\" (CSV: # implant: temporary), or leave dwell_s out");
  }
  if (!judged.temporary()) return;
  if (plan.says.without_dwell_time > 0) {
    found.refuse(Rule::dwell_missing, plan.file,
                 fmt::format("{} of {} sources of the temporary implant have no dwell time",
                             plan.says.without_dwell_time, plan.sources.size()),
                 "Give dwell_s in seconds for each of them, 0 where the source does not stay");
  }
  double all_s = 0.0, longest_s = 0.0;
  for (const PlannedSource& s : plan.sources) {
    all_s += s.dwell_s;
    longest_s = std::max(longest_s, s.dwell_s);
  }
  if (all_s <= 0.0) {
    found.refuse(Rule::dwell_missing, plan.file, "no source of the temporary implant stays anywhere",
                 "Give the dwell times in seconds");
  } else if (plan.says.type == "PDR") {
    return;
  } else if (judged.is_high_rate()) {
    const std::string what = fmt::format("all dwell times of the afterloader's plan are {:g} s together", all_s);
    if (!kHighRate_s.possible(all_s)) {
      found.refuse(Rule::implant_time, plan.file, what, "Give the dwell times in seconds");
    } else if (!kHighRate_s.plausible(all_s)) {
      found.warn(Rule::implant_time, "A" + what.substr(1) + "; check their unit (seconds)");
    }
  } else if (longest_s < kHour_s || longest_s > kLongestLowRate_s) {
    found.warn(Rule::implant_time,
               fmt::format("The sources of low dose rate lie for {:.4g} h at most; check the unit of "
                           "the times (seconds)",
                           longest_s / kHour_s));
  }
}

/// The file's own sums of strength and time. Files have the sum of a setup or that of the plan in each setup.
void judge_kerma(const Judged& judged, Findings& found) {
  double sum = 0.0, of_setups = 0.0;
  for (const PlannedSource& s : judged.plan.sources) {
    const double half_life = judged.models[s.kind].half_life_days;
    sum += s.strength_U * (judged.temporary() ? s.dwell_s / kHour_s : half_life * 24.0 / std::numbers::ln2);
  }
  const auto agree = [&](double kerma) { return std::abs(kerma / sum - 1.0) < kSameKerma; };
  for (const double kerma : judged.plan.says.total_kermas) of_setups += kerma;
  if (of_setups <= 0.0 || sum <= 0.0 || agree(of_setups)) return;
  if (std::all_of(judged.plan.says.total_kermas.begin(), judged.plan.says.total_kermas.end(), agree)) return;
  found.warn(
      Rule::total_kerma,
      fmt::format("The plan says a total reference air kerma (300A,0250) of {:.4g} µGy at 1 m, its strengths and "
                  "times give {:.4g}",
                  of_setups, sum));
}

}  // namespace

void judge_times(const Judged& judged, Findings& found) {
  judge_type(judged, found);
  for (const ChannelSays& channel : judged.plan.says.channels) judge_channel(judged, channel, found);
  judge_dwell_times(judged, found);
  judge_kerma(judged, found);
  if (judged.plan.says.has_beams)
    found.warn(Rule::not_computed, "The plan has external beams, too, whose dose is not computed");
  for (const std::string& entry : judged.plan.says.ignored)
    found.warn(Rule::not_computed, fmt::format("The entry '{}' of {} is not used", entry, judged.plan.file));
}

}  // namespace stylet::dose
