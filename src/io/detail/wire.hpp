// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_grid.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/geom/contours.hpp"
#include "stylet/geom/label_image.hpp"
#include "stylet/geom/surface.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/io/patient_record_io.hpp"

#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

/// Serialisation of the results of readers, and of the requests for them, to pass them between programs on one machine.
namespace stylet::detail {

/// A mesh, with notes on what the reader ignored.
struct MeshWithNotes {
  TetMesh mesh;
  std::vector<std::string> notes;
};

struct SurfacesWithNotes {
  std::vector<Surface> surfaces;
  std::vector<std::string> notes;
};

// One list of fields per type serves both for writing and for reading.
void fields(auto& wire, Error& e) { wire(e.kind, e.where, e.what, e.cure); }
void fields(auto& wire, Contour& c) { wire(c.points); }
void fields(auto& wire, Roi& r) { wire(r.name, r.number, r.type, r.colour, r.contours); }
void fields(auto& wire, PassedOver& p) { wire(p.name, p.why); }
void fields(auto& wire, ContourSet& s) {
  wire(s.source, s.label, s.frame_of_reference, s.rois, s.passed_over, s.notes);
}
void fields(auto& wire, LabelImage& i) {
  wire(i.source, i.size, i.origin, i.spacing, i.direction, i.labels, i.names, i.meanings, i.notes);
}
void fields(auto& wire, Surface& s) { wire(s.name, s.points, s.triangles); }
void fields(auto& wire, TetMesh& m) { wire(m.nodes, m.tets, m.tet_region, m.regions, m.surfaces); }
void fields(auto& wire, MeshWithNotes& m) { wire(m.mesh, m.notes); }
void fields(auto& wire, PlannedSource& s) {
  wire(s.at_mm, s.axis, s.has_axis, s.strength_U, s.dwell_s, s.over_s, s.kind, s.needle);
}
void fields(auto& wire, SourceKind& k) {
  wire(k.id, k.source_model, k.isotope, k.half_life_days, k.source_length_mm, k.source_diameter_mm, k.strength_date);
}
void fields(auto& wire, ChannelSays& c) {
  wire(c.where, c.total_s, c.final_weight, c.weights, c.points, c.points_said, c.pulses, c.shielded);
}
void fields(auto& wire, PlanSays& s) {
  wire(s.is_dicom, s.type, s.technique, s.today, s.fractions, s.prescriptions, s.setup_doses, s.total_kermas, s.unused,
       s.channels, s.longest_channel_s, s.dwell_of_permanent_s, s.without_dwell_time, s.repeated, s.has_beams,
       s.ignored);
}
void fields(auto& wire, DosePlan& p) {
  wire(p.file, p.uid, p.label, p.implant, p.frame_of_reference, p.source_model, p.isotope, p.half_life_days,
       p.source_length_mm, p.source_diameter_mm, p.strength_date, p.plan_date, p.prescription_Gy, p.source_id,
       p.more_kinds, p.sources, p.says, p.notes);
}
void fields(auto& wire, DoseGrid& g) {
  wire(g.file, g.frame_of_reference, g.plan_uid, g.type, g.summation, g.size, g.origin_mm, g.spacing_mm, g.direction,
       g.dose_Gy, g.quantum_Gy, g.largest_Gy, g.notes);
}
void fields(auto& wire, FoundPatient& p) {
  wire(p.file, p.name, p.id, p.id_issuer, p.birth_date, p.sex, p.study_uid, p.study_date, p.study_time, p.study_id,
       p.study_description, p.accession_number, p.referring_physician, p.frame_of_reference, p.position_reference,
       p.structure_set, p.notes);
}
void fields(auto& wire, SurfacesWithNotes& s) { wire(s.surfaces, s.notes); }

/// Types of plain numbers without padding, which are copied byte by byte.
template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class T, std::size_t N>
inline constexpr bool is_plain<std::array<T, N>> = is_plain<T>;
template <>
inline constexpr bool is_plain<Vec3> = true;
template <>
inline constexpr bool is_plain<Mat3> = true;

class WireWriter {
 public:
  template <class... T>
  void operator()(T&... values) {
    (put(values), ...);
  }
  std::string bytes;

 private:
  template <class T>
  void put(T& value) {
    if constexpr (is_plain<T>) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      fields(*this, value);
    }
  }
  void put_size(std::size_t size) { bytes.append(reinterpret_cast<const char*>(&size), sizeof size); }
  void put(std::string& text) {
    put_size(text.size());
    bytes += text;
  }
  template <class T>
  void put(std::vector<T>& values) {
    put_size(values.size());
    if constexpr (is_plain<T>) {
      bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    } else {
      for (T& value : values) put(value);
    }
  }
  template <class Key, class T>
  void put(std::map<Key, T>& values) {
    put_size(values.size());
    for (auto& [key, value] : values) {
      Key copy = key;
      put(copy);
      put(value);
    }
  }
};

/// Reads serialised values. Throws std::runtime_error if the bytes end too early.
class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : rest_(bytes) {}
  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }

 private:
  void copy(void* to, std::size_t size) {
    if (rest_.size() < size) throw std::runtime_error("incomplete result");
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  template <class T>
  void get(T& value) {
    if constexpr (is_plain<T>) {
      copy(static_cast<void*>(&value), sizeof value);
    } else {
      fields(*this, value);
    }
  }
  std::size_t get_size(std::size_t element) {
    std::size_t size = 0;
    copy(&size, sizeof size);
    if (size > rest_.size() / element) throw std::runtime_error("incomplete result");
    return size;
  }
  void get(std::string& text) {
    text.resize(get_size(1));
    copy(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (is_plain<T>) {
      values.resize(get_size(sizeof(T)));
      copy(static_cast<void*>(values.data()), values.size() * sizeof(T));
    } else {
      values.resize(get_size(1));
      for (T& value : values) get(value);
    }
  }
  template <class Key, class T>
  void get(std::map<Key, T>& values) {
    for (std::size_t n = get_size(1); n > 0; --n) {
      Key key{};
      get(key);
      get(values[key]);
    }
  }
  std::string_view rest_;
};

template <class T>
std::string to_bytes(Result<T>& result) {
  WireWriter wire;
  char good = result.ok() ? 1 : 0;
  wire(good);
  if (result.ok()) {
    wire(result.value());
  } else {
    Error error = result.error();
    wire(error);
  }
  return std::move(wire.bytes);
}

template <class T>
Result<T> from_bytes(std::string_view bytes) {
  WireReader wire(bytes);
  char good = 0;
  wire(good);
  if (good == 1) {
    T value;
    wire(value);
    return value;
  }
  Error error;
  wire(error);
  return error;
}

}  // namespace stylet::detail
