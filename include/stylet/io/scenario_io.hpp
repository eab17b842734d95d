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

/// Reads a scenario file (TOML, docs/scenario.md), applies settings, and checks the scenario. In the result,
/// patient.source (unless it is "phantom") and insertion[].motion are absolute paths; relative ones in the file start
/// at the file's folder. Errors name the file, the line (or the setting), the key, its value and the cure; for an
/// unknown key or table they suggest the nearest known name.
/// @param settings "needle.length_mm=150", "insertion[0].hole=D4", or "insertion.hole=D4" for the only insertion; the
///   value is a TOML value, or else a text. They are applied in order, after the file. A relative path in a setting
///   starts at the current folder or, if there is no such file, at the scenario file's folder.
Result<Scenario> read_scenario(const std::filesystem::path& path, std::span<const std::string> settings = {});

/// Reads a scenario, as read_scenario() does, from a text that stands for the content of the file `path`.
Result<Scenario> parse_scenario(const std::string& text, const std::filesystem::path& path,
                                std::span<const std::string> settings = {});

/// The complete scenario, defaults included, as the text of a TOML file with units in comments. Reading it gives the
/// same scenario if patient.source and motions are absolute paths, as after read_scenario().
std::string to_toml(const Scenario& scenario);

/// The output of `stylet insert --print-schema`: a TOML file, at most 110 columns wide, in which every key is commented
/// out and explained with unit, default, range and meaning, grouped by table.
std::string schema_text();

/// Reads a recorded base motion: CSV whose header names the columns time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz, in any order;
/// position of the needle's base [mm] LPS, rotation of the needle (its local z is the axis, base to tip) as a unit
/// quaternion with the real part qw.
/// @param notes gets a sentence if the quaternion's order may be another than the header says; may be null
/// Errors: no such file, wrong header, a field missing or not a finite number, times not increasing or negative, a
/// quaternion whose norm differs from 1 by more than 1e-3, fewer than two samples, quaternions that make sense in
/// another order only, positions, distances or speeds that
/// indicate other units than mm and s. Each error names the line and the column.
Result<std::vector<MotionSample>> read_motion_csv(const std::filesystem::path& path,
                                                  std::vector<std::string>* notes = nullptr);

}  // namespace stylet
