// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: save_box FOLDER. Writes box.stylet, the results of the C++ interface for it, and files that are not models.
#include "numbers.hpp"
#include "sim/box_patient.hpp"
#include "stylet/io/model_file.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

using namespace stylet;

namespace {

template <class T>
T taken(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  try {
    Scenario scenario = test::box_scenario();
    scenario.patient.source = "phantom";  // the only source that is not a path
    scenario.insertions.resize(3, scenario.insertions.front());
    scenario.insertions[1].entry_mm = {-5.0, 4.0, -20.0};
    scenario.insertions[2].entry_mm = {4.0, 6.0, -20.0};
    taken(save_model(*test::compiled(scenario), folder / "box.stylet"));

    const auto model = taken(load_model(folder / "box.stylet"));
    Simulation simulation(model);
    std::ofstream expected(folder / "box.numbers", std::ios::binary);
    for (const std::size_t insertion : {0, 1}) {
      const std::vector<double> numbers = test::numbers_of(simulation, insertion);
      expected.write(reinterpret_cast<const char*>(numbers.data()),
                     static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    }

    std::ifstream file(folder / "box.stylet", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    std::ofstream(folder / "cut.stylet", std::ios::binary) << whole.substr(0, whole.size() / 2);
    std::ofstream(folder / "text.stylet") << "[patient]\n";
    return expected.flush().good() ? 0 : 1;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
