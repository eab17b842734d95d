// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"
#include "h5.hpp"
#include "model/model_format.hpp"
#include "stylet/core/mirror.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <optional>

namespace stylet {
namespace fs = std::filesystem;
using namespace detail;

namespace {

constexpr const char* kPrepareAgain = "Prepare the model again: stylet prepare SCENARIO.toml -o MODEL.stylet";

struct NotAModel : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void demand(bool condition, const char* what) {
  if (!condition) throw NotAModel(what);
}

/// Reads datasets, none larger than the file.
class Reader {
 public:
  Reader(hid_t file, std::uintmax_t bytes) : file_(file), bytes_(bytes) {}

  ModelFile all(const Progress& progress) const {
    ModelFile file;
    file.version = h5::read_text_attribute(file_, "version");
    file.scenario_text = h5::read_text(file_, "scenario");
    file.notes = h5::read_texts(file_, "notes");
    file.mesh = mesh();
    const h5::Handle motions = h5::open_group(file_, "motions");
    for (int i = 0; h5::has_link(motions, fmt::format("{}", i).c_str()); ++i) {
      const auto rows = array<double>(motions, fmt::format("{}", i).c_str(), {0, kMotionNumbers}, H5T_NATIVE_DOUBLE);
      file.motions.push_back(motion_of(rows));
    }
    const h5::Handle group = h5::open_group(file_, "compliance");
    file.element = h5::read_text_attribute(group, "element");
    file.belongs_to = h5::read_text_attribute(group, "belongs_to");
    file.corridor = array<Index>(group, "corridor", {0}, H5T_NATIVE_INT);
    file.compliance.kernel = array<double>(group, "near_field_mm_per_N", {0}, H5T_NATIVE_DOUBLE);
    file.compliance.store = store(group, static_cast<Eigen::Index>(3 * file.corridor.size()), progress);
    return file;
  }

 private:
  /// @param shape 0 where any extent will do
  template <class Number>
  std::vector<Number> array(hid_t parent, const char* name, std::vector<hsize_t> shape, hid_t type) const {
    const h5::Handle set = h5::dataset(parent, name);
    const std::vector<hsize_t> found = h5::extents(set);
    demand(found.size() == shape.size(), name);
    hsize_t count = 1;
    for (std::size_t k = 0; k < shape.size(); ++k) {
      demand(shape[k] == 0 || found[k] == shape[k], name);
      demand(found[k] <= bytes_, name);
      count *= found[k];
    }
    demand(count <= bytes_ / sizeof(Number), name);
    std::vector<Number> values(count);
    h5::read_rows(set, type, 0, found[0], values.data());
    return values;
  }

  [[nodiscard]] TetMesh mesh() const {
    const h5::Handle group = h5::open_group(file_, "mesh");
    const auto nodes = array<double>(group, "nodes_mm", {0, 3}, H5T_NATIVE_DOUBLE);
    const auto tets = array<std::int32_t>(group, "tets", {0, 4}, H5T_NATIVE_INT32);
    TetMesh mesh;
    mesh.tet_region = array<int>(group, "tet_region", {tets.size() / 4}, H5T_NATIVE_INT);
    for (std::size_t k = 0; k < nodes.size(); k += 3) mesh.nodes.emplace_back(nodes[k], nodes[k + 1], nodes[k + 2]);
    for (std::size_t k = 0; k < tets.size(); k += 4)
      mesh.tets.push_back({tets[k], tets[k + 1], tets[k + 2], tets[k + 3]});
    mesh.regions = h5::read_texts(group, "regions");
    return mesh;
  }

  [[nodiscard]] MatX store(hid_t group, Eigen::Index size, const Progress& progress) const {
    const h5::Handle set = h5::dataset(group, "blocks_mm_per_N");
    const auto numbers = static_cast<hsize_t>(size) * static_cast<hsize_t>(size + 1) / 2;
    demand(numbers <= bytes_ / sizeof(double), "blocks_mm_per_N");
    demand(h5::extents(set) == std::vector<hsize_t>{numbers}, "blocks_mm_per_N");
    MatX store(size, size);
    std::vector<double> panel;
    hsize_t at = 0;
    for (Eigen::Index first = 0; first < size; first += kPanel) {
      report(progress, "loading", static_cast<double>(first) / static_cast<double>(size));
      const Eigen::Index last = std::min(first + kPanel, size);
      const auto count = static_cast<hsize_t>((last - first) * size - (last * (last - 1) - first * (first - 1)) / 2);
      panel.resize(count);
      h5::read_rows(set, H5T_NATIVE_DOUBLE, at, count, panel.data());
      at += count;
      const double* column_begin = panel.data();
      for (Eigen::Index column = first; column < last; ++column) {
        std::copy_n(column_begin, size - column, store.data() + column * size + column);
        column_begin += size - column;
      }
    }
    mirror_lower(store);
    return store;
  }

  hid_t file_;
  std::uintmax_t bytes_;
};

bool says_model(hid_t file) {
  return h5::has_attribute(file, "format") && h5::read_text_attribute(file, "format") == kModelFileFormat;
}

/// Whether an HDF5 file says that it holds a model; nothing where it cannot be asked.
std::optional<bool> model_in(const fs::path& path) {
  if (!is_hdf5_file(path)) return std::nullopt;
  const h5::LibraryTurn turn;
  try {
    return says_model(h5::open_file(path.c_str()));
  } catch (const h5::Failure&) {
    return std::nullopt;
  }
}

/// Tables whose outcome is in the file: settings there would do nothing.
Result<> check_settings(std::span<const std::string> settings, const std::string& where) {
  for (const std::string& setting : settings) {
    for (const char* table : {"patient.", "mesh."}) {
      if (setting.rfind(table, 0) == 0) {
        return input_error(fmt::format("--set {}", setting), fmt::format("the mesh is in {} already", where),
                           "Prepare a model with this setting: stylet prepare SCENARIO.toml --set …");
      }
    }
  }
  return Ok{};
}

}  // namespace

bool is_hdf5_file(const fs::path& path) {
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return false;  // opening a named pipe would wait for its other end
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, signature.size()> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == signature;
}

bool is_model_file(const fs::path& path) { return model_in(path).value_or(false); }

bool is_meant_as_model(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path, code) && model_in(path).value_or(path.extension() == kModelExtension);
}

Result<ModelFile> read_model_file(const fs::path& path, const Progress& progress) {
  const auto refuse = [&](const std::string& what) { return input_error(path.string(), what, kPrepareAgain); };
  std::error_code code;
  if (Result<> readable = detail::check_input_file(path); !readable) return refuse(readable.error().what);
  if (!is_hdf5_file(path)) return refuse("this is not a saved model");
  const h5::LibraryTurn turn;
  try {
    const h5::Handle file = h5::open_file(path.c_str());
    if (!says_model(file)) return refuse("this is an HDF5 file, but not a saved model");
    const auto format = h5::read_int_attribute(file, "format_version");
    demand(format.size() == 1, "format_version");
    if (format[0] != kModelFileVersion) {
      return refuse(fmt::format("the file has version {} of the format, this program reads version {}", format[0],
                                kModelFileVersion));
    }
    const std::string digest = h5::read_text_attribute(file, "sha256");
    ModelFile content = Reader(file, fs::file_size(path, code)).all(progress);
    if (content_digest(content) != digest) return refuse("damaged: its content is not what was written");
    return content;
  } catch (const h5::Failure& e) {
    return refuse(std::string("damaged: ") + e.what());
  } catch (const NotAModel& e) {
    return refuse(std::string("damaged: ") + e.what());
  } catch (const std::length_error& e) {
    return refuse(std::string("damaged: ") + e.what());
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
        settings.empty() ? fmt::format("its compliance was computed from something else than this "
                                       "program makes of its scenario (written by stylet {})",
                                       file.version)
                         : "these settings change what its compliance was computed from (tissue, "
                           "supports, element or the needles' ways)",
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
