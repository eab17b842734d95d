// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds that were found on images after an implant (docs/formats.md).
#include "detail/csv.hpp"
#include "detail/file_kind.hpp"
#include "detail/reach.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/found_seeds_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

/// Sources further from everything belong to another patient or frame; as for plans and structures.
constexpr double kOtherPatient_mm = 30.0;
/// From the prostate to the top of the lungs, into which seeds migrate, it is about 0.6 m.
constexpr double kOutOfPatient_mm = 1000.0;
/// Nearer centres are those of one seed that was entered twice; seeds are 0.8 mm thick.
constexpr double kOneSeed_mm = 0.5;

constexpr std::array kPlaceColumns{"x_mm", "y_mm", "z_mm"};
constexpr std::array kAxisColumns{"ax", "ay", "az"};

/// The numbers of three columns of a row. Error: one of them is not a finite number.
Result<Vec3> found_vector(const detail::CsvTable& table, std::size_t row, const std::array<const char*, 3>& columns) {
  Vec3 x;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Result<double> number = table.number(row, columns[k]);
    if (!number) return number.error();
    x[static_cast<Eigen::Index>(k)] = *number;
  }
  return x;
}

Result<FoundSeeds> found_in_table(const std::filesystem::path& path) {
  // The last two are columns of plans; a plan of seeds can be given as it is.
  const std::vector<std::string> known{"x_mm", "y_mm", "z_mm", "ax", "ay", "az", "needle", "strength_U"};
  const Result<detail::CsvTable> table = detail::read_csv_table(path, known);
  if (!table) return table.error();
  for (const char* column : kPlaceColumns) {
    if (!table->has(column)) {
      return input_error(fmt::format("{}, header line", table->file), fmt::format("the column {} is missing", column),
                         "Write x_mm,y_mm,z_mm in the first line, and below it a line for each seed");
    }
  }
  const bool with_axes = table->has("ax") || table->has("ay") || table->has("az");
  for (const char* column : kAxisColumns) {
    if (with_axes && !table->has(column)) {
      return input_error(fmt::format("{}, header line", table->file),
                         fmt::format("the column {} is missing beside the others of the axis", column),
                         "Give ax, ay and az, or none of them");
    }
  }
  FoundSeeds found;
  found.file = table->file;
  if (const auto frame = table->keys.find("frame_of_reference"); frame != table->keys.end())
    found.frame_of_reference = frame->second;
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    FoundSeed seed;
    seed.where = table->where(row);
    const Result<Vec3> at = found_vector(*table, row, kPlaceColumns);
    if (!at) return at.error();
    if (Result<> reach = detail::check_reach(seed.where, *at, "the seed"); !reach) return reach.error();
    seed.at_mm = *at;
    if (with_axes && !table->text(row, "ax").empty()) {
      const Result<Vec3> axis = found_vector(*table, row, kAxisColumns);
      if (!axis) return axis.error();
      if (!(axis->norm() > 1e-6)) {
        return input_error(seed.where, "the axis (0, 0, 0) has no length",
                           "Give three numbers that are not all 0, or leave ax, ay and az empty");
      }
      seed.axis = axis->normalized();
    }
    found.seeds.push_back(seed);
  }
  return found;
}

Result<FoundSeeds> found_in_plan(const std::filesystem::path& path) {
  Result<DosePlan> plan = read_plan(path);
  if (!plan) return plan.error();
  if (plan->implant == Implant::temporary) {
    return input_error(path.string(), "this is the plan of a temporary implant, which leaves no seeds",
                       "Give the seeds that were found after the permanent implant");
  }
  FoundSeeds found;
  found.file = path.string();
  found.frame_of_reference = plan->frame_of_reference;
  found.notes = std::move(plan->notes);
  for (std::size_t k = 0; k < plan->sources.size(); ++k) {
    const PlannedSource& source = plan->sources[k];
    FoundSeed seed{.at_mm = source.at_mm, .where = fmt::format("{}, seed {}", found.file, k + 1)};
    if (source.has_axis) seed.axis = source.axis;
    found.seeds.push_back(seed);
  }
  return found;
}

void note_repeated(FoundSeeds& found) {
  for (std::size_t a = 0; a < found.seeds.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double apart = (found.seeds[a].at_mm - found.seeds[b].at_mm).norm();
      if (apart >= kOneSeed_mm) continue;
      found.notes.push_back(
          fmt::format("{}: this seed is only {:.2f} mm from that of {}; if it was entered twice, remove one.",
                      found.seeds[a].where, apart, found.seeds[b].where));
      break;
    }
  }
}

double distance_to_plan(const FoundSeed& seed, const DosePlan& plan) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const PlannedSource& source : plan.sources) nearest = std::min(nearest, (source.at_mm - seed.at_mm).norm());
  return nearest;
}

std::string place_text(const Vec3& x) { return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", x.x(), x.y(), x.z()); }

}  // namespace

Result<FoundSeeds> read_found_seeds(const std::filesystem::path& path) {
  const Result<detail::FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  if (*kind != detail::FileKind::dicom && *kind != detail::FileKind::contour_json &&
      *kind != detail::FileKind::unknown) {
    return input_error(path.string(), "this is " + detail::name_of(*kind) + ", seeds found on images are expected",
                       "Give CSV with the columns x_mm, y_mm, z_mm, or a DICOM RTPLAN");
  }
  Result<FoundSeeds> found = *kind == detail::FileKind::unknown ? found_in_table(path) : found_in_plan(path);
  if (!found) return found;
  note_repeated(*found);
  return found;
}

Result<> check_found_seeds(const FoundSeeds& found, const DosePlan& plan) {
  constexpr const char* kSameFrame = "Give the seeds in the coordinates of the plan, in mm; register the images first";
  if (found.seeds.size() > 2 * plan.sources.size()) {
    return input_error(found.file,
                       fmt::format("{} seeds were found, and {} are planned", found.seeds.size(), plan.sources.size()),
                       "Give the seeds of this implant alone");
  }
  std::vector<double> distances;
  for (const FoundSeed& seed : found.seeds) {
    distances.push_back(distance_to_plan(seed, plan));
    if (distances.back() > kOutOfPatient_mm) {
      return input_error(seed.where,
                         fmt::format("the seed at {} is {:.0f} mm away from every planned seed, at most {:.0f} mm is "
                                     "expected in a patient",
                                     place_text(seed.at_mm), distances.back(), kOutOfPatient_mm),
                         kSameFrame);
    }
  }
  const auto far = static_cast<std::size_t>(
      std::count_if(distances.begin(), distances.end(), [](double mm) { return mm > kOtherPatient_mm; }));
  if (2 * far < distances.size()) return Ok{};
  const auto first = static_cast<std::size_t>(
      std::find_if(distances.begin(), distances.end(), [](double mm) { return mm > kOtherPatient_mm; }) -
      distances.begin());
  return input_error(
      found.seeds[first].where,
      fmt::format(
          "the seed at {} is {:.0f} mm away from every planned seed, and {} of {} seeds are further than {:.0f} "
          "mm",
          place_text(found.seeds[first].at_mm), distances[first], far, distances.size(), kOtherPatient_mm),
      kSameFrame);
}

}  // namespace stylet
