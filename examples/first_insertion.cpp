// SPDX-License-Identifier: GPL-3.0-or-later
// Inserts a needle into your own patient: an RT Structure Set, a mask or a mesh. Not a medical device.
//   build/bin/first_insertion my_structures.dcm
#include <stylet/patient/insert.hpp>

#include <iostream>

int main(int count, char** words) {
  stylet::Scenario scenario;
  scenario.patient.source = count > 1 ? words[1] : "phantom";  // the demo patient
  scenario.insertions = {{.hole = "e3.5"}};
  const auto prepared = stylet::prepare_model(scenario);
  if (!prepared) return std::cerr << prepared.error().message() << '\n', 2;
  for (const auto& warning : prepared->warnings()) std::cerr << "warning: " << warning << '\n';
  const auto result = stylet::insert(*prepared, "out/first");
  if (!result) return std::cerr << result.error().message() << '\n', 1;
  std::cout << "largest force " << result->summary.peak_axial_N << " N; see out/first/report.html\n";
}
