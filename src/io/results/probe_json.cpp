// SPDX-License-Identifier: GPL-3.0-or-later
#include "probe_json.hpp"

#include "stylet/sim/choices.hpp"

#include <nlohmann/json.hpp>

namespace stylet::results {

namespace {

nlohmann::ordered_json three(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

nlohmann::ordered_json probe_json(const ProbeReport& report) {
  return {{"kind", word(report.settings.kind)},
          {"array_mm", three(report.place.origin_mm)},
          {"axis", three(report.place.axes.col(2))},
          {"radius_mm", report.place.radius_mm},
          {"in_contours", report.settings.in_contours},
          {"force_N", three(report.press.force_N)},
          {"lasting_force_N", three(report.lasting_force_N)},
          {"moment_Nmm", three(report.press.moment_Nmm)},
          {"penetration_mm", report.press.penetration_mm},
          {"touching", report.press.touching},
          {"wall_points", report.wall_points},
          {"gland",
           {{"extent_mm", three(report.gland.extent_mm)},
            {"change_percent", three(report.gland.change_percent)},
            {"volume_percent", report.gland.volume_percent},
            {"shift_mm", three(report.gland.shift_mm)}}}};
}

}  // namespace stylet::results
