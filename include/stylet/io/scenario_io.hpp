// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/sim/motion.hpp"
#include "stylet/sim/scenario.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// Reads a scenario file (TOML, docs/scenario.md), applies settings, and checks the whole. patient.source and
/// insertion[].motion come out as absolute paths: relative ones start at the scenario file's folder; "phantom" stays.
/// Errors name the file, the line (or the setting), the key, its value and the cure; unknown keys and tables come with
/// the nearest known name.
/// @param settings "needle.length_mm=150", "insertion[0].hole=D4", or "insertion.hole=D4" for the only insertion; the
///        value is a TOML value, else taken as a text. Applied in order, after the file. A relative path in a setting
///        starts at the current folder or, where nothing is there, at the scenario file's.
Result<Scenario> read_scenario(const std::filesystem::path& path, std::span<const std::string> settings = {});

/// The same of a text, as if it were the content of the file `path`.
Result<Scenario> parse_scenario(const std::string& text, const std::filesystem::path& path,
                                std::span<const std::string> settings = {});

/// The scenario in full, defaults included, as a TOML file with units as comments. Reading it back gives the same
/// scenario, provided that patient.source and motions are absolute (as read_scenario() makes them).
std::string to_toml(const Scenario& scenario);

/// Every key with unit, default, range and meaning, grouped by table: a TOML file in which all keys are commented out,
/// at most 110 columns wide. What `stylet insert --print-schema` prints.
std::string schema_text();

/// Reads a recorded base motion: CSV with the header time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz; position of the needle's base
/// [mm] LPS, rotation of the needle (its local z is the axis, base to tip) as a unit quaternion.
/// Errors: no such file, wrong header, a field missing or not a finite number, times not increasing or negative, a
/// quaternion whose norm is off by more than 1e-3, fewer than two samples, positions, distances or speeds that betray
/// other units than mm and s. Each names the line and the column.
Result<std::vector<MotionSample>> read_motion_csv(const std::filesystem::path& path);

}  // namespace stylet
