// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/oedema_section.hpp"

#include "fixed_number.hpp"
#include "implant/implant_words.hpp"
#include "implant/json_parts.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::results {
namespace {

bool swells_alike(const Swelling& swelling) { return (swelling.at_start.array() == swelling.at_start.x()).all(); }

/// "14.5 % wider in each direction", or the three directions by name.
std::string width_in_words(const Swelling& swelling) {
  const auto wider = [](double part) {
    return fmt::format("{:g} % {}", std::abs(100.0 * part), part < 0.0 ? "narrower" : "wider");
  };
  const Vec3& s = swelling.at_start;
  if (swells_alike(swelling)) return wider(s.x()) + " in each direction";
  return fmt::format("{} from right to left, {} from anterior to posterior and {} from inferior to superior",
                     wider(s.x()), wider(s.y()), wider(s.z()));
}

}  // namespace

std::string oedema_words(const DoseCourse& course) {
  const DoseMoment& last = course.moments.back();
  const double taken = last.taken_away_Gy();
  std::string text = fmt::format(
      "On the day of the implant the gland is {}; what is left of this halves every {:g} days. Seeds and tissue move "
      "with it, so that the distances between them change, and with them the dose rate. Until the seeds have decayed, "
      "the target’s D90 is {} Gy; without swelling it would be {} Gy. ",
      width_in_words(course.swelling), course.swelling.half_life_days, fixed(last.d90_Gy, 0),
      fixed(last.d90_without_swelling_Gy, 0));
  if (!(std::abs(taken) >= 0.05)) return text + "The swelling changes D90 by less than 0.1 Gy.";
  const double half = course.days_until_half_is_taken();
  return text + fmt::format(
                    "The swelling {} {} Gy ({} %), half of it within the first {} days, when the seeds have "
                    "given {} % of their dose.",
                    taken > 0.0 ? "takes away" : "adds", fixed(std::abs(taken), 1),
                    fixed(100.0 * std::abs(taken) / last.d90_without_swelling_Gy, 1), fixed(half, 0),
                    fixed(100.0 * course.at(half).share, 0));
}

std::string oedema_section(const DoseCourse* course) {
  if (course == nullptr) return {};
  return fmt::format(
      "<section aria-labelledby=\"oedema\"><h2 id=\"oedema\">Dose while the gland swells</h2><p>{}</p><p>{}</p><div "
      "class=\"oedema needs-script\" id=\"oedema-charts\"></div>{}</section>",
      html_prose(oedema_words(*course)),
      "The pictures share the days since the implant. D90 is that of the dose accumulated until this day, of the seeds "
      "where they rest.",
      chart_note("summary.json"));
}

nlohmann::ordered_json oedema_curves_json(const DoseCourse& course) {
  constexpr double kHalfLives = 4.0;  // when 94 % of the dose is given
  constexpr int kParts = 120;
  Json json{{"days", Json::array()},
            {"swelling_percent", {Json::array(), Json::array(), Json::array()}},
            {"D90_Gy", Json::array()},
            {"D90_without_swelling_Gy", Json::array()}};
  for (int k = 0; k <= kParts; ++k) {
    const double days = kHalfLives * course.half_life_days * k / kParts;
    const DoseMoment moment = course.at(days);
    const Vec3 factors = course.swelling.factors(days);
    json["days"].push_back(days);
    for (Index axis = 0; axis < 3; ++axis)
      json["swelling_percent"][static_cast<std::size_t>(axis)].push_back(100.0 * (factors[axis] - 1.0));
    json["D90_Gy"].push_back(moment.d90_Gy);
    json["D90_without_swelling_Gy"].push_back(moment.d90_without_swelling_Gy);
  }
  const DoseMoment& last = course.moments.back();
  json["in_the_end_Gy"] = {last.d90_Gy, last.d90_without_swelling_Gy, last.taken_away_Gy()};
  return json;
}

nlohmann::ordered_json oedema_json(const DoseCourse& course) {
  Json moments = Json::array();
  for (const DoseMoment& m : course.moments) {
    moments.push_back({{"days", m.days},
                       {"swelling_percent", list_of(100.0 * (course.swelling.factors(m.days) - Vec3::Ones()))},
                       {"D90_Gy", m.d90_Gy},
                       {"D90_without_swelling_Gy", m.d90_without_swelling_Gy}});
  }
  return {{"samples", course.samples},
          {"D90_taken_away_Gy", course.moments.back().taken_away_Gy()},
          {"days_until_half_is_taken", course.days_until_half_is_taken()},
          {"moments", moments}};
}

}  // namespace stylet::results
