// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"
#include "model/model_format.hpp"
#include "model/sealed_file.hpp"
#include "stylet/core/mirror.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <ranges>
#include <span>
#include <type_traits>

namespace stylet {
namespace fs = std::filesystem;
using namespace detail;

namespace {

using Json = nlohmann::json;

constexpr const char* kPrepareAgain = "Prepare the model again: stylet prepare SCENARIO.toml -o MODEL.stylet";

struct NotAModel : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void demand(bool condition, const std::string& what) {
  if (!condition) throw NotAModel(what);
}

/// Lengths, compliances and coefficients are far below this. A larger number, or one that is none, would show as a step
/// without a balance or as a picture that cannot be written.
constexpr double kLargest = 1e30;

/// @param name of the array that has the numbers
void demand_possible(std::span<const double> values, const std::string& name) {
  const bool possible = std::ranges::all_of(values, [](double x) { return std::abs(x) <= kLargest; });
  demand(possible, name + ": a number that no model has");
}

/// Reads the arrays of a model file by their positions; none can be larger than the file. Throws NotAModel, NotSealed
/// or exceptions of the JSON library.
class Reader {
 public:
  Reader(const SealedFile& file, const Json& index) : file_(file), arrays_(index.at("arrays")) {}

  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const {
    const Place place = of(name);
    demand(place.item_bytes > 0, name);
    std::string all(place.items * place.item_bytes, '\0');
    file_.read(place.at, all.size(), all.data());
    std::vector<std::string> texts;
    for (std::uint64_t k = 0; k < place.items; ++k) {
      const std::string padded = all.substr(k * place.item_bytes, place.item_bytes);
      texts.push_back(padded.substr(0, padded.find_last_not_of('\0') + 1));
    }
    return texts;
  }

  [[nodiscard]] std::string text(const std::string& name) const {
    const auto all = texts(name);
    demand(all.size() == 1, name);
    return all.front();
  }

  [[nodiscard]] bool has(const std::string& name) const { return arrays_.contains(name); }

  /// Reads an array. @param shape expected extents; 0 = any
  template <class Number>
  [[nodiscard]] std::vector<Number> numbers(const std::string& name, const std::vector<std::uint64_t>& shape) const {
    const Place place = of(name);
    demand(place.item_bytes == sizeof(Number) && place.shape.size() == shape.size(), name);
    for (std::size_t k = 0; k < shape.size(); ++k) demand(shape[k] == 0 || place.shape[k] == shape[k], name);
    std::vector<Number> values(place.items);
    file_.read(place.at, place.items * sizeof(Number), values.data());
    if constexpr (std::is_same_v<Number, double>) demand_possible(values, name);
    return values;
  }

  [[nodiscard]] TetMesh mesh() const {
    const auto nodes = numbers<double>("/mesh/nodes_mm", {0, 3});
    const auto tets = numbers<std::int32_t>("/mesh/tets", {0, 4});
    TetMesh mesh;
    mesh.tet_region = numbers<std::int32_t>("/mesh/tet_region", {tets.size() / 4});
    for (std::size_t k = 0; k < nodes.size(); k += 3) mesh.nodes.emplace_back(nodes[k], nodes[k + 1], nodes[k + 2]);
    for (std::size_t k = 0; k < tets.size(); k += 4)
      mesh.tets.push_back({tets[k], tets[k + 1], tets[k + 2], tets[k + 3]});
    mesh.regions = texts("/mesh/regions");
    if (has("/mesh/surface_sizes")) {
      auto surfaces = unflatten(
          {numbers<float>("/mesh/surface_points_mm", {0, 3}), numbers<Index>("/mesh/surface_triangles", {0, 3}),
           numbers<Index>("/mesh/surface_sizes", {mesh.regions.size(), 2})},
          mesh.regions);
      demand(surfaces.has_value(), "/mesh/surface_points_mm");
      mesh.surfaces = *std::move(surfaces);
    }
    return mesh;
  }

  /// Reads a square matrix.
  [[nodiscard]] MatX square(const std::string& name) const {
    const std::uint64_t rows = of(name).shape.at(0);
    const auto values = numbers<double>(name, {rows, rows});
    return Eigen::Map<const MatX>(values.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(rows));
  }

  /// Reads a symmetric matrix, whose lower triangle is in the file column by column.
  [[nodiscard]] MatX symmetric(const std::string& name, Eigen::Index size, const Progress& progress) const {
    const Place place = of(name);
    const auto count = static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(size + 1) / 2;
    demand(place.item_bytes == sizeof(double) && place.shape == std::vector<std::uint64_t>{count}, name);
    MatX matrix(size, size);
    std::uint64_t at = place.at;
    for (Eigen::Index column = 0; column < size; ++column) {
      if (column % kPanel == 0) report(progress, "loading", static_cast<double>(column) / static_cast<double>(size));
      const std::uint64_t bytes = static_cast<std::uint64_t>(size - column) * sizeof(double);
      double* const from = matrix.data() + column * size + column;
      file_.read(at, bytes, from);
      demand_possible(std::span(from, static_cast<std::size_t>(size - column)), name);
      at += bytes;
    }
    mirror_lower(matrix);
    return matrix;
  }

 private:
  struct Place {
    std::uint64_t at = 0;
    std::uint64_t item_bytes = 0;
    std::vector<std::uint64_t> shape;
    std::uint64_t items = 1;
  };

  [[nodiscard]] Place of(const std::string& name) const {
    const Json& entry = arrays_.at(name);
    Place place{entry.at("at").get<std::uint64_t>(), entry.at("item_bytes").get<std::uint64_t>(),
                entry.at("shape").get<std::vector<std::uint64_t>>()};
    demand(place.item_bytes <= file_.size(), name);
    for (const std::uint64_t extent : place.shape) {
      demand(extent == 0 || place.items <= file_.size() / extent, name);
      place.items *= extent;
    }
    demand(place.items == 0 || place.item_bytes <= file_.size() / place.items, name);
    return place;
  }

  const SealedFile& file_;
  const Json& arrays_;
};

ModelFile content_of(const Json& index, const Reader& reader, const Progress& progress) {
  ModelFile file;
  file.version = index.at("version").get<std::string>();
  file.element = index.at("element").get<std::string>();
  file.belongs_to = index.at("belongs_to").get<std::string>();
  file.scenario_text = reader.text("/scenario");
  file.notes = reader.texts("/notes");
  file.mesh = reader.mesh();
  for (int i = 0; reader.has(fmt::format("/motions/{}", i)); ++i)
    file.motions.push_back(motion_of(reader.numbers<double>(fmt::format("/motions/{}", i), {0, kMotionNumbers})));
  file.corridor = reader.numbers<Index>("/compliance/corridor", {0});
  file.compliance.kernel = reader.numbers<double>("/compliance/near_field_mm_per_N", {0});
  file.compliance.spread = reader.square("/compliance/spread_mm_per_N");
  file.compliance.store =
      reader.symmetric("/compliance/blocks_mm_per_N", static_cast<Eigen::Index>(3 * file.corridor.size()), progress);
  return file;
}

}  // namespace

Result<> check_settings(std::span<const std::string> settings, const std::string& where) {
  for (const std::string& setting : settings) {
    for (const char* table : {"patient.", "mesh."}) {
      if (setting.rfind(table, 0) == 0) {
        return input_error(fmt::format("--set {}", setting), fmt::format("{} already has the finished mesh", where),
                           "Start from the scenario with this setting: stylet prepare SCENARIO.toml --set …");
      }
    }
  }
  return Ok{};
}

bool is_hdf5_file(const fs::path& path) {
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return false;  // opening a named pipe would wait for its other end
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, signature.size()> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == signature;
}

bool is_model_file(const fs::path& path) { return is_hdf5_file(path) && SealedFile::is_marked(path); }

bool is_meant_as_model(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path, code) && (path.extension() == kModelExtension || is_model_file(path));
}

Result<ModelFile> read_model_file(const fs::path& path, const Progress& progress) {
  const auto refuse = [&](const std::string& what) { return input_error(path.string(), what, kPrepareAgain); };
  if (Result<> readable = detail::check_input_file(path); !readable) return refuse(readable.error().what);
  if (!is_hdf5_file(path)) return refuse("this is not a saved model");
  if (!SealedFile::is_marked(path)) {
    return refuse(
        "the end of a saved model is missing: the file is truncated or damaged, an earlier version of stylet saved it, "
        "or it is not a model");
  }
  try {
    const SealedFile file(path, [&](double share) { report(progress, "checking the saved model", share); });
    const Json index = Json::parse(file.index());
    if (const int version = index.at("format_version").get<int>(); version != kModelFileVersion) {
      return refuse(fmt::format("the file has version {} of the format, this program reads version {}", version,
                                kModelFileVersion));
    }
    return content_of(index, Reader(file, index), progress);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const NotSealed& e) {
    return refuse(std::string("damaged: ") + e.what());
  } catch (const NotAModel& e) {
    return refuse(std::string("damaged: ") + e.what());
  } catch (const std::exception&) {
    return refuse("damaged: its index does not describe a model");
  }
}

Result<std::shared_ptr<const Model>> compile_model(ModelFile file, const fs::path& path, const Progress& progress,
                                                   std::span<const std::string> settings) {
  const std::string where = path.string();
  if (auto checked = check_settings(settings, where); !checked) return checked.error();
  const Result<Scenario> scenario = parse_scenario(file.scenario_text, path, settings);
  if (!scenario) return scenario.error();
  auto model =
      Model::compile(*scenario, std::move(file.mesh), where, file.motions, progress, std::move(file.compliance));
  if (!model) return model.error();
  if (compliance_origin((*model)->tissue()) != file.belongs_to) {
    return input_error(
        where,
        settings.empty() ? fmt::format("its compliance does not belong to the model that this program makes from its "
                                       "scenario (written by stylet {})",
                                       file.version)
                         : "these settings change data on which its compliance depends (tissue, supports, element or "
                           "the needles' ways)",
        settings.empty() ? kPrepareAgain : "Prepare a model with these settings: stylet prepare SCENARIO.toml --set …");
  }
  return model;
}

Result<std::shared_ptr<const Model>> load_model(const fs::path& path, const Progress& progress,
                                                std::span<const std::string> settings) {
  Result<ModelFile> file = read_model_file(path, progress);
  if (!file) return file.error();
  return compile_model(std::move(*file), path, progress, settings);
}

}  // namespace stylet
