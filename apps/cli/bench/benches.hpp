// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "../console.hpp"

#include "stylet/core/need.hpp"
#include "stylet/measure/scale_bench.hpp"

#include <string>
#include <vector>

namespace stylet::cli {

/// Arguments of `stylet bench WHAT`. 0 stands for the default of the benchmark.
struct BenchArguments {
  std::string what;
  int nodes = 0;
  int contacts = 0;
  int needles = 0;
  long steps = 0;
};

inline constexpr int kRemeshNodes = 1331;

Result<> bench_pictures_command(const BenchArguments& arguments, Console& console);
Result<> bench_remesh_command(const BenchArguments& arguments, Console& console);
Result<> bench_scale_command(const BenchArguments& arguments, Console& console);
Result<> bench_dose_command(const BenchArguments& arguments, Console& console);
Result<> bench_together_command(const BenchArguments& arguments, Console& console);

/// Refuses `--nodes` below `fewest`.
/// @param why the reason for this minimum, shown as the last clause of the error
Result<> check_nodes(const std::string& benchmark, int nodes, int fewest, const std::string& why);

/// The machine on which the times were measured.
Json machine_json();

Json times_json(const measure::StepTimes& times);

/// A number with `digits` digits after the decimal point; "-" if it is not finite.
std::string number(double value, int digits);

/// A number for JSON; null if it is not finite.
Json or_null(double value);

}  // namespace stylet::cli
