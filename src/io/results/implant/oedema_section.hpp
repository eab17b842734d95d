// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_over_time.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// The section of the report on the dose of the target while the gland swells, as words and JSON.
namespace stylet::results {

/// The section of the page, as HTML: sentences, and the place of the charts (web/report/src/implant/charts.ts).
/// @param course nullptr: there is no
/// swelling, and no section
std::string oedema_section(const DoseCourse* course);

/// How much of the target's D90 the swelling takes away, and when, in sentences.
std::string oedema_words(const DoseCourse& course);

/// The curves of the charts at days [d] since the implant: the width of the gland beyond its own [%] along x, y and z,
/// D90 [Gy] so far with and without swelling; and both D90 and their difference in the end.
nlohmann::ordered_json oedema_curves_json(const DoseCourse& course);

/// The key `oedema` of summary.json (docs/results).
nlohmann::ordered_json oedema_json(const DoseCourse& course);

}  // namespace stylet::results
