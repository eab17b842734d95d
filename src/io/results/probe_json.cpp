// SPDX-License-Identifier: GPL-3.0-or-later
#include "probe_json.hpp"

#include "record/json.hpp"
#include "stylet/sim/choices.hpp"

namespace stylet::results {

using record::list_of;

nlohmann::ordered_json probe_json(const ProbeReport& report) {
  return {{"kind", word(report.settings.kind)},
          {"array_mm", list_of(report.place.origin_mm)},
          {"axis", list_of(report.place.axes.col(2))},
          {"radius_mm", report.place.radius_mm},
          {"in_contours", report.settings.in_contours},
          {"force_N", list_of(report.press.force_N)},
          {"lasting_force_N", list_of(report.lasting_force_N)},
          {"moment_Nmm", list_of(report.press.moment_Nmm)},
          {"penetration_mm", report.press.penetration_mm},
          {"touching", report.press.touching},
          {"wall_points", report.wall_points},
          {"gland",
           {{"extent_mm", list_of(report.gland.extent_mm)},
            {"change_percent", list_of(report.gland.change_percent)},
            {"volume_percent", report.gland.volume_percent},
            {"shift_mm", list_of(report.gland.shift_mm)}}}};
}

}  // namespace stylet::results
