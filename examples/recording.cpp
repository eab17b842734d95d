// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the recording of a run, which may still be going on or may have been killed.
//   build/bin/recording out/demo/run.h5
#include <stylet/io/recording_io.hpp>

#include <algorithm>
#include <iostream>

int main(int count, char** words) {
  if (count != 2) return std::cerr << "usage: recording OUT/run.h5\n", 2;
  const auto run = stylet::read_recording(words[1]);
  if (!run) return std::cerr << run.error().message() << '\n', 2;
  double peak_N = 0.0;
  for (const stylet::Step& step : run->steps) peak_N = std::max(peak_N, step.force_axial_N);
  std::cout << run->info.scenario_name << ": " << run->steps.size() << " steps, largest axial force " << peak_N
            << " N\n";
  if (!run->summary) std::cout << "there is no summary: the run still goes on, or it was killed\n";
}
