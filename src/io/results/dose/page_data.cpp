// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_data.hpp"

#include "dose/difference_view.hpp"
#include "dose/dose_view.hpp"
#include "dose/structure_look.hpp"
#include "dose/structure_mask.hpp"
#include "record/json.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stylet::results {
namespace {

static_assert(std::endian::native == std::endian::little, "typed arrays in the page are little-endian");

using record::Json;

// Upper bounds of what the page holds, over all structures.
constexpr double kMostCubes = 1.4e6;       // one byte each
constexpr double kMostTriangles = 6e4;     // 18 bytes each
constexpr double kMostDosePoints = 7e5;    // two bytes each
constexpr std::size_t kMostCloud = 40000;  // twelve bytes each
constexpr double kMostCorners = 1e5;       // twelve bytes each

double two_decimals(double value) { return std::round(100.0 * value) / 100.0; }

Json dvh_json(const DvhTable& dvh) {
  Json percent = Json::array();
  for (const std::vector<double>& curve : dvh.percent) {
    Json values = Json::array();
    for (const double value : curve) values.push_back(two_decimals(value));
    percent.push_back(std::move(values));
  }
  return {{"dose_Gy", dvh.dose_Gy}, {"percent", std::move(percent)}};
}

/// Every point, or every second, third, …, so that there are at most so many.
Json points_text(const std::vector<Vec3>& points, std::size_t most) {
  std::vector<float> values;
  const std::size_t every = most == 0 ? 1 : (points.size() + most - 1) / most;
  for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(every, 1)) {
    for (int j = 0; j < 3; ++j) values.push_back(static_cast<float>(points[k][j]));
  }
  return base64_of<float>(values);
}

Json mask_json(const StructureMask& mask) {
  return {{"size", mask.size},
          {"origin_mm", record::list_of(mask.origin_mm)},
          {"spacing_mm", mask.spacing_mm},
          {"share", base64_of<std::uint8_t>(mask.share)}};
}

Json structure_surface_json(const StructureSurface& surface) {
  return {{"points_mm", base64_of<float>(surface.points_mm)},
          {"triangles", base64_of<std::uint32_t>(surface.triangles)}};
}

/// The contours themselves, for the sections that lie in their planes.
Json contours_json(const StructureDose& structure, double share) {
  std::size_t corners = 0;
  for (const Contour& contour : structure.contours) corners += contour.points.size();
  const auto every = static_cast<std::size_t>(1.0 + static_cast<double>(corners) / (share * kMostCorners));
  Json list = Json::array();
  for (const Contour& contour : structure.contours) {
    if (contour.points.size() < 3) continue;
    std::vector<Vec3> points;  // a contour with few corners keeps all of them
    const std::size_t step = contour.points.size() > 24 * every ? every : 1;
    for (std::size_t k = 0; k < contour.points.size(); k += step) points.push_back(contour.points[k]);
    list.push_back(points_text(points, points.size()));
  }
  return list;
}

Json difference_json(const DoseEvaluation& evaluation, const DoseView& view, const std::vector<IsodoseLevel>& levels) {
  if (!evaluation.comparison || evaluation.comparison->difference.dose_Gy.empty() || levels.empty()) return nullptr;
  const double limit_Gy = 0.2 * levels.front().dose_Gy;  // a tenth of the dose of the second line
  const ViewedDifference seen =
      viewed_difference(evaluation.comparison->difference, view, limit_Gy, 0.5 * kMostDosePoints);
  return {{"size", seen.size},
          {"origin_mm", record::list_of(seen.origin_mm)},
          {"spacing_mm", seen.spacing_mm},
          {"limit_Gy", seen.limit_Gy},
          {"values", base64_of<std::uint8_t>(seen.value)}};
}

Json structures_json(const DoseEvaluation& evaluation, const std::vector<std::string>& colours) {
  Json list = Json::array();
  const double share = 1.0 / std::max(4.0, static_cast<double>(evaluation.structures.size()));
  for (std::size_t k = 0; k < evaluation.structures.size(); ++k) {
    const StructureDose& structure = evaluation.structures[k];
    const auto mask = structure_mask(structure, share * kMostCubes);
    const auto most_cloud = static_cast<std::size_t>(share * kMostCloud);
    list.push_back(
        {{"name", structure.name},
         {"region", structure.region},
         {"color", colours[k]},
         {"background", surrounds_others(structure)},
         {"mask", mask ? mask_json(*mask) : Json(nullptr)},
         {"surface", mask ? structure_surface_json(mask_surface(*mask, share * kMostTriangles)) : Json(nullptr)},
         {"contours_mm", contours_json(structure, share)},
         {"cloud_mm", mask ? Json("") : points_text(structure.cloud, most_cloud)}});
  }
  return list;
}

Json levels_json(const std::vector<IsodoseLevel>& levels) {
  Json list = Json::array();
  for (const IsodoseLevel& level : levels) {
    list.push_back({{"dose_Gy", level.dose_Gy}, {"label", level.label}, {"color", level.colour}, {"main", level.main}});
  }
  return list;
}

Json dose_grid_json(const ViewedDose& dose) {
  return {{"size", dose.size},
          {"origin_mm", record::list_of(dose.origin_mm)},
          {"spacing_mm", dose.spacing_mm},
          {"scale_Gy", dose.scale_Gy},
          {"ceiling_Gy", dose.ceiling_Gy},
          {"values", base64_of<std::uint16_t>(dose.value)}};
}

Json sources_json(const DoseEvaluation& evaluation) {
  std::vector<Vec3> places, axes;
  Json needles = Json::array(), dwells = Json::array();
  for (const PlannedSource& source : evaluation.plan.sources) {
    places.push_back(source.at_mm);
    axes.push_back(source.axis);
    needles.push_back(source.needle);
    dwells.push_back(source.dwell_s);
  }
  return {{"temporary", evaluation.plan.implant == Implant::temporary},
          {"length_mm", evaluation.source.outer_length_mm},
          {"diameter_mm", evaluation.source.outer_diameter_mm},
          {"places_mm", points_text(places, places.size())},
          {"axes", points_text(axes, axes.size())},
          {"needles", std::move(needles)},
          {"dwell_s", std::move(dwells)}};
}

}  // namespace

std::string dose_page_data(const DoseEvaluation& evaluation, const DvhTable& dvh,
                           const std::vector<std::string>& colours) {
  const DoseView view = dose_view(evaluation);
  const std::vector<IsodoseLevel> levels = isodose_levels(evaluation);
  const double ceiling = levels.empty() ? 0.0 : 2.5 * levels.back().dose_Gy;
  const Json json = {
      {"prescription_Gy", record::or_null(evaluation.prescription_Gy)},
      {"dvh", dvh_json(dvh)},
      {"centre_mm", record::list_of(view.centre_mm)},
      {"half_mm", view.half_mm},
      {"levels", levels_json(levels)},
      {"dose", dose_grid_json(viewed_dose(evaluation.grid, view, ceiling, kMostDosePoints))},
      {"difference", difference_json(evaluation, view, levels)},
      {"structures", structures_json(evaluation, colours)},
      {"sources", sources_json(evaluation)},
  };
  return record::compact(json);
}

}  // namespace stylet::results
