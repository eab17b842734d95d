// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/unfinished.hpp"
#include "h5_mesh.hpp"
#include "h5_new_file.hpp"
#include "model/model_format.hpp"
#include "model/sealed_file.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>

namespace stylet {
namespace fs = std::filesystem;
using namespace detail;

namespace {

/// Writes the lower triangle of the compliance, column by column.
void write_store(const h5::NewFile& file, hid_t group, const MatX& store, const Progress& progress) {
  const auto size = static_cast<hsize_t>(store.cols());
  const hsize_t numbers = size * (size + 1) / 2;
  h5::write_array(group, "blocks_mm_per_N", H5T_NATIVE_DOUBLE, {&numbers, 1}, nullptr);
  const h5::Handle set = h5::dataset(group, "blocks_mm_per_N");
  std::vector<double> panel;
  hsize_t at = 0;
  for (Eigen::Index first = 0; first < store.cols(); first += kPanel) {
    report(progress, "saving", static_cast<double>(first) / static_cast<double>(store.cols()));
    panel.clear();
    for (Eigen::Index column = first; column < std::min(first + kPanel, store.cols()); ++column)
      panel.insert(panel.end(), store.data() + column * store.rows() + column,
                   store.data() + (column + 1) * store.rows());
    h5::write_rows(set, H5T_NATIVE_DOUBLE, at, panel.size(), panel.data());
    file.check();
    at += panel.size();
  }
}

/// The index of the file: positions of all arrays, for readers without HDF5.
std::string index_of(hid_t file, const ModelFile& content) {
  std::vector<std::string> names{"/scenario",
                                 "/notes",
                                 "/mesh/nodes_mm",
                                 "/mesh/tets",
                                 "/mesh/tet_region",
                                 "/mesh/regions",
                                 "/compliance/corridor",
                                 "/compliance/blocks_mm_per_N",
                                 "/compliance/near_field_mm_per_N",
                                 "/compliance/spread_mm_per_N"};
  if (!content.mesh.surfaces.empty()) {
    for (const char* name : {"points_mm", "triangles", "sizes"}) names.push_back(fmt::format("/mesh/surface_{}", name));
  }
  for (std::size_t i = 0; i < content.motions.size(); ++i) names.push_back(fmt::format("/motions/{}", i));
  nlohmann::ordered_json arrays;
  for (const std::string& name : names) {
    const h5::Handle set = h5::dataset(file, name.c_str());
    arrays[name] = {{"at", h5::place(set)}, {"item_bytes", h5::item_bytes(set)}, {"shape", h5::extents(set)}};
  }
  const nlohmann::ordered_json index{{"format", kModelFileFormat},       {"format_version", kModelFileVersion},
                                     {"version", content.version},       {"element", content.element},
                                     {"belongs_to", content.belongs_to}, {"arrays", arrays}};
  return json_text(index, 1);
}

void write(const fs::path& path, const ModelFile& content, const Progress& progress) {
  h5::NewFile file(path.c_str());
  h5::write_attribute(file, "format", std::string(kModelFileFormat));
  h5::write_attribute(file, "format_version", std::array{kModelFileVersion});
  h5::write_attribute(file, "version", content.version);
  h5::write_attribute(file, "units", std::string("mm, N, s"));
  h5::write_attribute(file, "frame", std::string("LPS"));
  h5::write_text(file, "scenario", content.scenario_text);
  h5::write_texts(file, "notes", content.notes);
  h5::write_mesh(file, content.mesh);
  {
    const h5::Handle motions = h5::group(file, "motions");
    for (std::size_t i = 0; i < content.motions.size(); ++i) {
      const std::array<hsize_t, 2> shape{content.motions[i].size(), kMotionNumbers};
      h5::write_array(motions, fmt::format("{}", i).c_str(), H5T_NATIVE_DOUBLE, shape,
                      motion_rows(content.motions[i]).data());
    }
    const h5::Handle group = h5::group(file, "compliance");
    h5::write_attribute(group, "element", content.element);
    h5::write_attribute(group, "belongs_to", content.belongs_to);
    const hsize_t corridor = content.corridor.size();
    h5::write_array(group, "corridor", H5T_NATIVE_INT, {&corridor, 1}, content.corridor.data());
    const hsize_t kernel = content.compliance.kernel.size();
    h5::write_array(group, "near_field_mm_per_N", H5T_NATIVE_DOUBLE, {&kernel, 1}, content.compliance.kernel.data());
    const auto samples = static_cast<hsize_t>(content.compliance.spread.rows());
    const std::array<hsize_t, 2> square{samples, samples};
    h5::write_array(group, "spread_mm_per_N", H5T_NATIVE_DOUBLE, square, content.compliance.spread.data());
    write_store(file, group, content.compliance.store, progress);
  }
  const std::string index = index_of(file, content);
  file.close();
  SealedFile::seal(path, index);
}

}  // namespace

Result<> save_model(const Model& model, const fs::path& path, std::span<const std::string> notes,
                    const Progress& progress) {
  const std::string where = path.string();
  if (model.inverse()) {
    return input_error(where,
                       fmt::format("coupling.engine = \"{}\" keeps the full inverse, which is not saved",
                                   word(model.scenario().coupling.engine)),
                       "Use coupling.engine = \"condensed\"");
  }
  if (model.own_parts().is_any()) {
    return input_error(where, "the needle or the law of cutting is a part of the program, which is not saved",
                       "Save the model before Model::with(), and add the parts again after it has been read");
  }
  const Tissue& tissue = model.tissue();
  ModelFile file;
  file.version = version();
  file.scenario_text = to_toml(model.scenario());
  file.notes.assign(notes.begin(), notes.end());
  file.mesh = model.mesh();
  for (const PlannedInsertion& insertion : model.insertions())
    file.motions.push_back(insertion.recorded ? insertion.motion.samples() : std::vector<MotionSample>{});
  file.element = to_string(tissue.element());
  file.corridor = tissue.corridor();
  file.compliance.store = model.store()->blocks();
  if (model.kernel()) file.compliance.kernel = model.kernel()->numbers();
  if (model.spread()) file.compliance.spread = model.spread()->matrix();
  file.belongs_to = compliance_origin(tissue);
  // A model holds the patient's organs.
  auto hidden = Unfinished::create(path, Unfinished::Kind::private_file);
  if (!hidden) return hidden.error();
  if (auto done = h5::written(path, [&] { write(hidden->path(), file, progress); }); !done) return done;
  return hidden->finish();
}

}  // namespace stylet
