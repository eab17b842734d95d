// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_data.hpp"

#include "implant/implant_words.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace stylet::results {
namespace {

using PageJson = nlohmann::ordered_json;

double hundredths(double value) { return std::round(100.0 * value) / 100.0; }

PageJson seed_place_json(const Vec3& mm) { return {hundredths(mm.x()), hundredths(mm.y()), hundredths(mm.z())}; }

}  // namespace

std::string implant_page_data(const ImplantHistory& history, const DvhTable& planned) {
  PageJson percent = PageJson::array(), seeds = PageJson::array(), thirds = PageJson::array();
  for (const std::vector<double>& curve : planned.percent) {
    PageJson& values = percent.emplace_back(PageJson::array());
    for (const double value : curve) values.push_back(hundredths(value));
  }
  const std::vector<std::size_t> third_of = thirds_of(history);
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    const SeedHistory& seed = history.seeds[k];
    seeds.push_back({{"number", seed.number + 1},
                     {"needle", history.needles[seed.needle].name},
                     {"planned_mm", seed_place_json(seed.planned_mm)},
                     {"rest_mm", seed.lost ? PageJson(nullptr) : seed_place_json(seed.rest_mm)},
                     {"third", third_of[k]}});
  }
  for (std::size_t k = 0; k < kThirds.size(); ++k)
    thirds.push_back({{"name", kThirds[k]}, {"color", kThirdColours[k]}});
  const PageJson json = {{"planned_percent", percent}, {"thirds", thirds}, {"seeds", seeds}};
  return json.dump(-1, ' ', false, PageJson::error_handler_t::replace);
}

}  // namespace stylet::results
