// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_meshes.hpp"

#include "io/detail/private_files.hpp"
#include "io/detail/remark.hpp"
#include "io/detail/wire.hpp"
#include "io/model/digest.hpp"
#include "stylet/io/files.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

namespace fs = std::filesystem;

namespace stylet {

namespace detail {

void fields(auto& wire, SoftLayers& l) {
  wire(l.periprostatic_fat_mm, l.levator_mm, l.ischiorectal_fat_mm, l.subcutaneous_fat_mm, l.rectal_wall_mm);
}
void fields(auto& wire, MeshOptions& o) {
  wire(o.preset, o.nodes, o.cull_tolerance_mm, o.regions, o.skip, o.stiff_band, o.layers);
}
void fields(auto& wire, Range& r) { wire(r.min, r.max); }
void fields(auto& wire, MeshQuality& q) {
  wire(q.nodes, q.tets, q.dihedral_deg, q.edge_mm, q.radius_ratio_min, q.fraction_below_12_deg, q.region_volume_cc,
       q.region_tets, q.dihedral_histogram);
}
void fields(auto& wire, RegionReport& r) {
  wire(r.name, r.tets, r.volume_cc, r.input_volume_cc, r.structure_volume_cc, r.surface_mean_mm, r.surface_max_mm);
}
void fields(auto& wire, MeshReport& r) {
  wire(r.quality, r.regions, r.surface_mean_mm, r.surface_max_mm, r.contour_points, r.contour_points_kept, r.seconds,
       r.notes);
}
void fields(auto& wire, MeshedAnatomy& m) { wire(m.mesh, m.report); }

}  // namespace detail

namespace {

/// The running program, which is another one after each build.
std::string program() {
  std::error_code unknown;
  const fs::path path = fs::read_symlink("/proc/self/exe", unknown);
  if (unknown) return {};
  return fmt::format("{} {}", path.string(), fs::last_write_time(path, unknown).time_since_epoch().count());
}

std::string sha256(const std::string& bytes) {
  detail::Digest digest;
  digest.add(bytes);
  return digest.finish();
}

/// The file of the mesh of this input in the folder for such files; nothing if none is named.
std::optional<fs::path> file_of(auto input, MeshOptions options) {
  const char* folder = std::getenv("STYLET_CACHE");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  std::string build = program();
  if (build.empty()) return std::nullopt;
  detail::WireWriter wire;
  wire(build, input, options);
  return fs::path(folder) / fmt::format("mesh-{}.bin", sha256(wire.bytes));
}

constexpr std::size_t kDigits = 64;  ///< of a digest; it stands before the bytes of a mesh

std::optional<MeshedAnatomy> read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (bytes.size() < kDigits || bytes.substr(0, kDigits) != sha256(bytes.substr(kDigits))) return std::nullopt;
  MeshedAnatomy mesh;
  detail::WireReader wire(std::string_view(bytes).substr(kDigits));
  wire(mesh);
  return mesh;
}

Result<MeshedAnatomy> kept_or_made(const auto& input, const MeshOptions& options, const auto& make) {
  const std::optional<fs::path> path = file_of(input, options);
  if (path) {
    if (auto kept = read(*path)) return *std::move(kept);
  }
  Result<MeshedAnatomy> made = make();
  if (path && made) {
    detail::WireWriter wire;
    wire(*made);
    detail::make_private_folder(path->parent_path());
    Result<> kept = make_folder(path->parent_path());  // says why there is none
    if (kept) kept = write_whole_file(*path, sha256(wire.bytes) + wire.bytes, FileReaders::owner);
    if (!kept)
      detail::remark(fmt::format("The mesh was not kept in {} (STYLET_CACHE): {}.", path->parent_path().string(),
                                 kept.error().what));
  }
  return made;
}

}  // namespace

Result<MeshedAnatomy> mesh_once(const ContourSet& contours, const MeshOptions& options, const Progress& progress) {
  return kept_or_made(contours, options, [&] { return mesh_contours(contours, options, progress); });
}

Result<MeshedAnatomy> mesh_once(const LabelImage& image, const MeshOptions& options, const Progress& progress) {
  return kept_or_made(image, options, [&] { return mesh_labels(image, options, progress); });
}

}  // namespace stylet
