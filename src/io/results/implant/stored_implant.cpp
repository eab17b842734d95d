// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/stored_implant.hpp"

#include "h5_mesh.hpp"
#include "h5_new_file.hpp"
#include "model/digest.hpp"
#include "record/attributes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace stylet::results {
namespace {

void demand_shape(bool fits, const std::string& what) {
  if (!fits) throw h5::Failure(what + " has the wrong shape");
}

/// The digest of the values of a file in their order, each with its name.
class Seal {
 public:
  template <class... T>
  void add(const std::string& name, T&... values) {
    detail::WireWriter wire;
    wire(values...);
    digest_.add(name);
    digest_.add(wire.bytes);
  }
  template <class T>
  void add_rows(const std::string& name, const record::Rows<T>& rows) {
    std::string values;
    for (std::size_t k = 0; k < rows.size(); ++k)
      rows.each_value(
          k, [&](std::span<const char> value, const record::Column&) { values.append(value.begin(), value.end()); });
    add(name, values);
  }
  [[nodiscard]] std::string finish() { return digest_.finish(); }

 private:
  detail::Digest digest_;
};

/// Number of items of an array. Throws h5::Failure if it is beyond 64 bits.
hsize_t product(const std::vector<hsize_t>& counts) {
  hsize_t all = 1;
  for (const hsize_t count : counts) {
    demand_shape(count == 0 || all <= std::numeric_limits<hsize_t>::max() / count, "an array");
    all *= count;
  }
  return all;
}

/// Type of the numbers in a list of numbers, points or characters.
template <class Values>
hid_t number_type_of() {
  using V = typename Values::value_type;
  if constexpr (std::same_as<V, Vec3>)
    return H5T_NATIVE_DOUBLE;
  else
    return h5::number_type(V{});
}

/// Writes the parts of a file, or reads them into the same values: one list of the contents serves for both. The
/// functions throw h5::Failure.
class ImplantFile {
 public:
  ImplantFile(hid_t at, Seal& seal, bool writes) : at_(at), seal_(seal), writes_(writes) {}

  template <class T>
  void attributes(T& record) {
    record::each_field<record::kFile>(record, [&](const record::Field& field, auto& value) {
      if (!writes_ && record::lacks(at_, field)) return;
      const std::string name = record::name_of(field);
      writes_ ? record::write_attribute(at_, name, value) : record::read_attribute(at_, name, value);
      seal_.add(name, value);
    });
  }
  template <class T>
  void rows(const char* name, std::vector<T>& records) {
    const auto rows = writes_ ? record::rows_of(std::span<const T>(records)) : record::read_rows<T>(at_, name);
    if (writes_) record::write_rows(at_, name, rows);
    records.resize(rows.size());
    for (std::size_t k = 0; k < rows.size() && !writes_; ++k)
      if (!rows.get(k, records[k])) throw h5::Failure(std::string(name) + " has a number that means nothing");
    seal_.add_rows(name, rows);
  }
  /// @param inner extents of the axes but the first; those that are 0 are set when reading
  template <class Values>
  void array(const char* name, Values& values, std::vector<hsize_t>&& inner = {}) {
    array(name, values, inner);
  }
  template <class Values>
  void array(const char* name, Values& values, std::vector<hsize_t>& inner) {
    const hid_t type = number_type_of<Values>();
    constexpr std::size_t item = sizeof(typename Values::value_type);
    if (writes_) {
      std::vector<hsize_t> shape{0};
      shape.insert(shape.end(), inner.begin(), inner.end());
      if (const hsize_t row = product(inner) * H5Tget_size(type); row > 0) shape[0] = values.size() * item / row;
      h5::write_array(at_, name, type, shape, values.data());
    } else {
      const h5::Handle set = h5::dataset(at_, name);
      const std::vector<hsize_t> shape = h5::extents(set);
      demand_shape(shape.size() == inner.size() + 1, name);
      for (std::size_t k = 0; k < inner.size(); ++k) {
        if (inner[k] == 0) inner[k] = shape[k + 1];
        demand_shape(inner[k] == shape[k + 1], name);
      }
      values.resize(product(shape) * H5Tget_size(type) / item);
      if (!values.empty()) h5::read_rows(set, type, 0, shape[0], std::as_writable_bytes(std::span(values)));
    }
    seal_.add(name, values);
  }
  void text(const char* name, std::string& text) {
    writes_ ? h5::write_text(at_, name, text) : void(text = h5::read_text(at_, name));
    seal_.add(name, text);
  }
  void texts(const char* name, std::vector<std::string>& texts) {
    writes_ ? h5::write_texts(at_, name, texts) : void(texts = h5::read_texts(at_, name));
    seal_.add(name, texts);
  }
  void mesh(TetMesh& mesh) {
    writes_ ? h5::write_mesh(at_, mesh) : void(mesh = h5::read_mesh(at_));
    seal_.add("mesh", mesh.nodes, mesh.tets, mesh.tet_region, mesh.regions);
    if (!mesh.surfaces.empty()) seal_.add("surfaces", mesh.surfaces);  // earlier versions have none
  }
  /// A group with the contents of an item.
  template <class Item>
  void group(const std::string& name, Item& item);
  /// A group with a group for each item.
  template <class Item>
  void members(const char* name, std::vector<Item>& items) {
    const h5::Handle group = open(name);
    H5G_info_t info{};
    h5::check(H5Gget_info(group, &info), name);
    const std::size_t count = writes_ ? items.size() : info.nlinks;
    ImplantFile inside(group, seal_, writes_);
    for (std::size_t k = 0; k < count; ++k) {
      if (!writes_) items.emplace_back();
      inside.group(fmt::format("{:03}", k), items[k]);
    }
  }

 private:
  [[nodiscard]] h5::Handle open(const std::string& name) const {
    return writes_ ? h5::group(at_, name.c_str()) : h5::open_group(at_, name.c_str());
  }
  hid_t at_;
  Seal& seal_;
  bool writes_;
};

// Lists of lists are one array in the file: they are joined, written or read, and taken apart again.

void contents(ImplantFile& file, NeedleHistory& needle) {
  file.attributes(needle);
  file.rows("steps", needle.record.steps);
  file.rows("events", needle.events);
  std::vector<Vec3> all;
  for (const NeedleShape& shape : needle.record.shapes)
    all.insert(all.end(), shape.points_mm.begin(), shape.points_mm.end());
  file.rows("shapes", needle.record.shapes);
  file.array("shapes_mm", all, {kNeedleShapePoints, 3});
  demand_shape(all.size() == needle.record.shapes.size() * kNeedleShapePoints, "shapes_mm");
  for (auto from = all.begin(); NeedleShape & shape : needle.record.shapes) {
    shape.points_mm.assign(from, from + kNeedleShapePoints);
    from += kNeedleShapePoints;
  }
}

void contents(ImplantFile& file, RecordedStructure& structure) {
  file.attributes(structure);
  std::vector<Vec3> all;
  std::vector<std::int64_t> counts;
  for (const Contour& contour : structure.contours) {
    all.insert(all.end(), contour.points.begin(), contour.points.end());
    counts.push_back(static_cast<std::int64_t>(contour.points.size()));
  }
  file.array("contour_points_mm", all, {3});
  file.array("contour_sizes", counts);
  structure.contours.resize(counts.size());
  auto from = all.begin();
  for (std::size_t k = 0; k < counts.size(); ++k) {
    demand_shape(counts[k] >= 0 && counts[k] <= all.end() - from, "contour_sizes");
    structure.contours[k].points.assign(from, from + counts[k]);
    from += counts[k];
  }
  file.array("cloud_mm", structure.cloud_mm, {3});
}

void contents(ImplantFile& file, RecordedDose& dose) {
  file.attributes(dose);
  auto& size = dose.grid.size;
  std::vector<hsize_t> plane{static_cast<hsize_t>(size[1]), static_cast<hsize_t>(size[0])};
  file.array("dose_Gy", dose.grid.dose_Gy, plane);
  const hsize_t layer = product(plane);
  const std::array<hsize_t, 3> counts{plane[1], plane[0], layer > 0 ? dose.grid.dose_Gy.size() / layer : 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    demand_shape(counts[axis] <= hsize_t{std::numeric_limits<Index>::max()}, "dose_Gy");
    size[axis] = static_cast<Index>(counts[axis]);
  }
  file.array("dvh_dose_Gy", dose.dose_Gy);
  std::vector<double> all;
  for (const std::vector<double>& curve : dose.percent) all.insert(all.end(), curve.begin(), curve.end());
  std::vector<hsize_t> inner{dose.dose_Gy.size()};
  file.array("dvh_percent", all, inner);
  demand_shape(inner[0] == dose.dose_Gy.size(), "dvh_percent");
  if (inner[0] == 0) return;
  const auto length = static_cast<std::ptrdiff_t>(inner[0]);
  dose.percent.resize(all.size() / inner[0]);
  for (auto from = all.begin(); std::vector<double> & curve : dose.percent) {
    curve.assign(from, from + length);
    from += length;
  }
}

void contents(ImplantFile& file, ImplantRecord& record) {
  file.attributes(record);
  file.text("scenario", record.scenario_text);
  file.texts("warnings", record.warnings);
  file.array("summary_json", record.summary);
  file.mesh(record.mesh);
  file.members("needles", record.needles);
  file.members("stabilising", record.stabilising);
  file.rows("seeds", record.seeds);
  file.members("structures", record.structures);
  file.group("planned", record.planned);
  file.group("delivered", record.delivered);
}

template <class Item>
void ImplantFile::group(const std::string& name, Item& item) {
  const h5::Handle group = open(name);
  ImplantFile inside(group, seal_, writes_);
  contents(inside, item);
}

/// The digest of a file of version 2, in its own order. Enumerations were numbers of four bytes.
std::string digest_of_version_2(ImplantRecord& r) {
  detail::WireWriter wire;
  const auto count = [&](std::size_t number) { wire(number); };
  const auto needles = [&](std::vector<NeedleHistory>& all) {
    count(all.size());
    for (NeedleHistory& n : all) {
      wire(n.name, n.entry_mm, n.direction, n.depth_mm, n.peak_force_N, n.deflection_mm, n.gland_shift_mm, n.events,
           n.steps, n.seconds, n.record.group);
      count(n.record.steps.size());
      for (Step& s : n.record.steps) {
        auto& q = s.base.rotation.coeffs();
        wire(s.time_s, s.dt_s, s.base_depth_mm, s.base.origin, q.x(), q.y(), q.z(), q.w(), s.force_axial_N,
             s.force_sagittal_N, s.force_lateral_N, s.torque_Nmm, s.tip_mm, s.tip_state, s.contacts, s.sticking,
             s.iterations, s.step_us, s.rest_steps, s.flags);
      }
      wire(n.record.shapes);
    }
  };
  wire(r.version, r.scenario_name, r.scenario_text, r.source, r.prescription_Gy, r.needle_diameter_mm,
       r.needle_length_mm, r.seed_length_mm, r.mesh.nodes, r.mesh.tets, r.mesh.tet_region, r.mesh.regions);
  needles(r.needles);
  needles(r.stabilising);
  count(r.seeds.size());
  for (SeedHistory& s : r.seeds) {
    wire(s.number, s.needle, s.planned_mm, s.dropped_mm, s.rest_mm, s.axis, s.dropped_s, s.lost, s.in_tissue);
    for (const SeedCauseWords& words : kSeedCauses)
      if (words.since <= 2) wire(s.by(words.cause));
  }
  wire(r.structures, r.planned, r.delivered, r.warnings, r.summary);
  detail::Digest digest;
  digest.add(wire.bytes);
  return digest.finish();
}

ImplantRecord whole_implant_in(hid_t file) {
  if (!h5::has_attribute(file, "format") || h5::read_text_attribute(file, "format") != kImplantFileFormat)
    throw h5::Failure("an HDF5 file, but not that of an implant");
  int version = 0;
  record::read_attribute(file, "format_version", version);
  if (version > implant_file_version()) throw h5::Failure("written by a newer version of stylet");
  if (version < 2) throw h5::Failure("written by an older version of stylet, whose seeds have fewer causes");
  Seal seal;
  ImplantRecord record;
  ImplantFile reader(file, seal, false);
  contents(reader, record);
  for (const SeedHistory& seed : record.seeds) demand_shape(seed.needle < record.needles.size(), "/seeds: needle");
  if (h5::read_text_attribute(file, "content_sha256") != (version == 2 ? digest_of_version_2(record) : seal.finish()))
    throw h5::Failure("damaged: its content has changed since it was written");
  if (version == 2 && record.summary.find("\"dwell_positions\":") != std::string::npos)
    record.implant = Implant::temporary;
  return record;
}

}  // namespace

void write_stored_implant(const char* path, ImplantRecord record) {
  h5::NewFile file(path);
  h5::write_attribute(file, "format", std::string(kImplantFileFormat));
  h5::write_attribute(file, "format_version", std::array{implant_file_version()});
  h5::write_attribute(file, "units", std::string("mm, N, s, Gy"));
  h5::write_attribute(file, "frame", std::string("LPS"));
  Seal seal;
  ImplantFile writer(file, seal, true);
  contents(writer, record);
  h5::write_attribute(file, "content_sha256", seal.finish());
  file.close();
}

Result<ImplantRecord> parse_implant_file(const std::filesystem::path& path) {
  const h5::LibraryTurn turn;
  try {
    return whole_implant_in(h5::open_growing_file(path.c_str()));
  } catch (const h5::Failure& e) {
    return input_error(path.string(), e.what(), kGiveAnImplant);
  }
}

Result<bool> is_implant_file(const std::filesystem::path& path) {
  const h5::LibraryTurn turn;
  try {
    const h5::Handle file = h5::open_growing_file(path.c_str());
    return h5::has_attribute(file, "format") && h5::read_text_attribute(file, "format") == kImplantFileFormat;
  } catch (const h5::Failure&) {
    return false;  // no file of HDF5
  }
}

}  // namespace stylet::results
