// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "../console.hpp"

#include "stylet/measure/scale_bench.hpp"

#include <string>
#include <vector>

namespace stylet::cli {

/// `stylet bench WHAT`, one function a benchmark.
struct BenchArguments {
  std::string what;
  int nodes = 0;         ///< 0 = the default of what is measured
  int contacts = 0;      ///< 0 = the default
  long steps = 0;        ///< 0 = the default
  double seconds = 0.0;  ///< 0 = the default
  double speed = 0.0;    ///< [mm/s], 0 = the default
};

inline constexpr int kRemeshNodes = 1331;

Result<> bench_remesh_command(const BenchArguments& arguments, Console& console);
Result<> bench_scale_command(const BenchArguments& arguments, Console& console);
Result<> bench_step_command(const BenchArguments& arguments, Console& console);
Result<> bench_loop_command(const BenchArguments& arguments, Console& console);
Result<> bench_supply_command(const BenchArguments& arguments, Console& console);
Result<> bench_display_command(const BenchArguments& arguments, Console& console);
Result<> bench_viewers_command(const BenchArguments& arguments, Console& console);

/// Refuses `--nodes` below `fewest`.
/// @param why says where that number comes from
Result<> check_nodes(const std::string& benchmark, int nodes, int fewest, const std::string& why);

/// The machine times are of.
Json machine_json();

Json times_json(const measure::StepTimes& times);

/// A number with so many digits after the point; "-" where there is none.
std::string number(double value, int digits);

/// The same in JSON: null where there is none.
Json or_null(double value);

}  // namespace stylet::cli
