// SPDX-License-Identifier: GPL-3.0-or-later
// A law of cutting of one's own: a cutting force that grows with a power of the speed, in the gland only. Not a medical
// device.
#include <stylet/patient/insert.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>

/// F = C (1 + (v / v0)^n) in one region, the built-in law F = C + eta v everywhere else.
class PowerLaw final : public stylet::CuttingModel {
 public:
  explicit PowerLaw(int region) : region_(region) {}
  std::string name() const override { return "power law"; }
  Law law(const Tip& tip) const override {
    if (tip.region != region_) return {tip.cutting_N, tip.viscosity_Ns_per_mm};
    constexpr double v0_mm_per_s = 20.0;
    constexpr double n = 0.5;
    return {tip.cutting_N * (1.0 + std::pow(tip.cut_mm_per_s / v0_mm_per_s, n)), tip.viscosity_Ns_per_mm};
  }

 private:
  int region_;
};

/// [N] Axial force of the hand as the needle comes to its full depth, where it cuts through the gland.
double force_at_depth(const stylet::InsertResult& result) {
  const auto shallower = [](const auto& a, const auto& b) { return a.base_depth_mm < b.base_depth_mm; };
  return std::max_element(result.steps.begin(), result.steps.end(), shallower)->force_axial_N;
}

int main() {
  for (const double speed : {5.0, 50.0}) {
    stylet::Scenario scenario;
    scenario.patient.source = "phantom";  // the demo patient
    scenario.mesh.nodes = 800;            // coarse, so that the example is quick
    scenario.insertions = {{.hole = "e3.5", .speed_mm_per_s = speed}};
    scenario.output.pictures = false;
    auto prepared = stylet::prepare_model(scenario);
    if (!prepared) return std::cerr << prepared.error().message() << '\n', 2;
    const auto built_in = stylet::insert(*prepared, "out/built_in_law");
    if (!built_in) return std::cerr << built_in.error().message() << '\n', 1;
    const int gland = prepared->model->mesh().region_index("prostate");
    auto mine = prepared->model->with({.cutting = std::make_shared<PowerLaw>(gland)});
    if (!mine) return std::cerr << mine.error().message() << '\n', 2;
    prepared->model = *mine;
    const auto own = stylet::insert(*prepared, "out/own_law");
    if (!own) return std::cerr << own.error().message() << '\n', 1;
    std::cout << "at " << speed << " mm/s the force in the gland is " << force_at_depth(*built_in)
              << " N by the built-in law and " << force_at_depth(*own) << " N by the power law\n";
  }
}
