// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/whole_file.hpp"
#include "h5.hpp"
#include "h5_mesh.hpp"
#include "model/model_format.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <array>

namespace stylet {
namespace fs = std::filesystem;
using namespace detail;

namespace {

constexpr hsize_t kChunk = 1 << 16;  // numbers

/// The lower triangle, column by column.
void write_store(hid_t group, const MatX& store, const Progress& progress) {
  const h5::Handle set = h5::growing_dataset(group, "blocks_mm_per_N", H5T_NATIVE_DOUBLE, {}, kChunk, nullptr);
  std::vector<double> panel;
  for (Eigen::Index first = 0; first < store.cols(); first += kPanel) {
    report(progress, "saving", static_cast<double>(first) / static_cast<double>(store.cols()));
    panel.clear();
    for (Eigen::Index column = first; column < std::min(first + kPanel, store.cols()); ++column)
      panel.insert(panel.end(), store.data() + column * store.rows() + column,
                   store.data() + (column + 1) * store.rows());
    h5::append_rows(set, H5T_NATIVE_DOUBLE, panel.size(), panel.data());
  }
}

void write(const fs::path& path, const ModelFile& content, const Progress& progress) {
  const h5::Handle access(h5::check(H5Pcreate(H5P_FILE_ACCESS), "create file"), H5Pclose);
  h5::check(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "create file");
  h5::Handle file(h5::check(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), "create file"), H5Fclose);
  h5::write_attribute(file, "format", std::string(kModelFileFormat));
  h5::write_attribute(file, "format_version", std::array{kModelFileVersion});
  h5::write_attribute(file, "version", content.version);
  h5::write_attribute(file, "units", std::string("mm, N, s"));
  h5::write_attribute(file, "frame", std::string("LPS"));
  h5::write_attribute(file, "sha256", content_digest(content));
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
    write_store(group, content.compliance.store, progress);
  }
  if (!file.reset()) h5::fail("close");
}

}  // namespace

Result<> save_model(const Model& model, const fs::path& path, std::span<const std::string> notes,
                    const Progress& progress) {
  const std::string where = path.string();
  if (model.inverse()) {
    return input_error(where,
                       fmt::format("coupling.engine = \"{}\" keeps the full inverse, which is not saved",
                                   model.scenario().coupling.engine),
                       "Use coupling.engine = \"condensed\"");
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
  file.belongs_to = compliance_origin(tissue);
  return write_whole(path, [&](const fs::path& temporary) -> Result<> {
    const h5::LibraryTurn turn;
    try {
      write(temporary, file, progress);
      return Ok{};
    } catch (const h5::Failure& e) {
      return failure(where, std::string("cannot be written: ") + e.what(), "Check the free space and the permissions");
    }
  });
}

}  // namespace stylet
