// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of NRRD, including 3D Slicer's .seg.nrrd, with Teem (the format's own library).
#include "detail/input_file.hpp"
#include "detail/parsers.hpp"
#include "detail/text.hpp"
#include "image/segments.hpp"
#include "image/voxels.hpp"

#include <fmt/format.h>
#include <teem/nrrd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <set>

namespace stylet::detail {

namespace {

struct NrrdCloser {
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
};
using NrrdPointer = std::unique_ptr<Nrrd, NrrdCloser>;

/// The innermost line of Teem's last error message.
std::string last_error() {
  char* text = biffGetDone(NRRD);
  const std::string all = text == nullptr ? "" : text;
  std::free(text);
  std::string innermost;
  for (const auto line : split(all, '\n')) {
    if (!trimmed(line).empty()) innermost = trimmed(line);
  }
  const auto end = innermost.find(": ");
  return end == std::string::npos ? innermost : innermost.substr(end + 2);
}

Result<VoxelType> voxel_type(int type, const std::string& source) {
  switch (type) {
    case nrrdTypeChar:
      return VoxelType::int8;
    case nrrdTypeUChar:
      return VoxelType::uint8;
    case nrrdTypeShort:
      return VoxelType::int16;
    case nrrdTypeUShort:
      return VoxelType::uint16;
    case nrrdTypeInt:
      return VoxelType::int32;
    case nrrdTypeUInt:
      return VoxelType::uint32;
    case nrrdTypeLLong:
      return VoxelType::int64;
    case nrrdTypeULLong:
      return VoxelType::uint64;
    case nrrdTypeFloat:
      return VoxelType::float32;
    case nrrdTypeDouble:
      return VoxelType::float64;
    default:
      return input_error(source, fmt::format("the voxel type '{}' is not supported", airEnumStr(nrrdType, type)),
                         "Export the mask as 8- or 16-bit whole numbers");
  }
}

/// The factors, 1 or −1, that convert coordinates of the file's space to LPS.
Result<Vec3> to_lps(const Nrrd& nrrd, const std::string& source) {
  switch (nrrd.space) {
    case nrrdSpaceLeftPosteriorSuperior:
      return Vec3(1, 1, 1);
    case nrrdSpaceRightAnteriorSuperior:
      return Vec3(-1, -1, 1);
    case nrrdSpaceLeftAnteriorSuperior:
      return Vec3(1, -1, 1);
    default:
      return input_error(
          source,
          nrrd.space == nrrdSpaceUnknown
              ? std::string("the header does not state the position of the image in the patient (no 'space')")
              : fmt::format("the space '{}' is not a frame of the patient", airEnumStr(nrrdSpace, nrrd.space)),
          "Write 'space: left-posterior-superior' (or right-anterior-superior, left-anterior-superior), "
          "'space directions' and 'space origin'");
  }
}

/// Length of a unit [mm]; 0 if the unit is unknown.
double unit_mm(const char* unit) {
  struct Unit {
    double mm;
    std::set<std::string_view> names;
  };
  static const std::vector<Unit> units{
      {1.0, {"", "mm", "millimeter", "millimetre"}},
      {10.0, {"cm", "centimeter", "centimetre"}},
      {1000.0, {"m", "meter", "metre"}},
      {0.001, {"um", "\u00b5m", "\u03bcm", "micron", "micrometer", "micrometre"}},  // micro sign, Greek letter mu
      {1e-6, {"nm", "nanometer", "nanometre"}},
      {25.4, {"in", "inch", "inches", "\""}},
  };
  std::string name = unit == nullptr ? "" : lower(trimmed(unit));
  if (name.size() > 3 && name.ends_with('s') && name != "inches") name.pop_back();
  for (const Unit& known : units) {
    if (known.names.contains(name)) return known.mm;
  }
  return 0.0;
}

/// A segment as 3D Slicer describes it by the keys SegmentN_Name, SegmentN_LabelValue and SegmentN_Layer.
struct SegmentKeys {
  std::string name;
  int value = 0;  ///< label value in its layer
  std::size_t layer = 0;
};

struct SegmentTexts {
  std::optional<std::string> name, value, layer;
};

/// The values of these keys as text, for each number N.
std::map<int, SegmentTexts> segment_texts(const Nrrd& nrrd) {
  constexpr std::string_view start = "Segment";
  std::map<int, SegmentTexts> segments;
  for (unsigned n = 0; n < nrrdKeyValueSize(&nrrd); ++n) {
    char* key_text = nullptr;
    char* value_text = nullptr;
    nrrdKeyValueIndex(&nrrd, &key_text, &value_text, n);
    const std::string key = key_text == nullptr ? "" : key_text,
                      value = trimmed(value_text == nullptr ? "" : value_text);
    std::free(key_text);
    std::free(value_text);
    const auto end = key.find('_');
    if (!key.starts_with(start) || end == std::string::npos) continue;
    const std::string_view digits = std::string_view(key).substr(start.size(), end - start.size());
    const bool number =
        !digits.empty() && digits.size() < 9 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (!number) continue;
    const std::string what = key.substr(end + 1);
    const int segment = std::stoi(std::string(digits));
    if (what == "Name") segments[segment].name = value;
    if (what == "LabelValue") segments[segment].value = value;
    if (what == "Layer") segments[segment].layer = value;
  }
  std::erase_if(segments, [](const auto& s) { return !s.second.name && !s.second.value; });
  return segments;
}

/// Whether the file is one of 3D Slicer up to 4.10: its segments have names, but neither a label nor a layer, since
/// each of them is a volume of its own.
bool has_volume_for_each(const std::map<int, SegmentTexts>& segments) {
  return !segments.empty() && std::none_of(segments.begin(), segments.end(), [](const auto& s) {
    return s.second.value.has_value() || s.second.layer.has_value();
  });
}

/// Converts a text to a whole number; empty if it is not one or out of bounds.
std::optional<int> whole_number(const std::string& text, int least, int most) {
  const double value = to_number(text).value_or(-1.0);
  if (!(value >= least && value <= most) || value != std::floor(value)) return std::nullopt;
  return static_cast<int>(value);
}

/// The segments that the header describes correctly; notes say what is wrong with the others.
/// @param layers number of layers in the file
/// @param own_volumes segment N is volume N (has_volume_for_each()), and its label there is 1
std::vector<SegmentKeys> segment_keys(const std::map<int, SegmentTexts>& described, std::size_t layers,
                                      bool own_volumes, std::vector<std::string>& notes) {
  std::vector<SegmentKeys> segments;
  for (const auto& [n, texts] : described) {
    const std::string called = texts.name && !texts.name->empty()
                                   ? fmt::format("Segment '{}'", *texts.name)
                                   : fmt::format("The segment with number {} in the header", n);
    if (own_volumes) {
      if (static_cast<std::size_t>(n) < layers) {
        segments.push_back({texts.name.value_or(""), 1, static_cast<std::size_t>(n)});
      } else {
        notes.push_back(
            fmt::format("{} has no voxels: it would be volume {}, and the file has {}.", called, n + 1, layers));
      }
      continue;
    }
    const std::string value = texts.value.value_or(std::to_string(n + 1)), layer = texts.layer.value_or("0");
    const auto number = whole_number(value, 1, 65535), at = whole_number(layer, 0, 65535);
    if (!number) {
      notes.push_back(fmt::format("{} has no voxels: its Segment{}_LabelValue is '{}', 1 to 65535 is expected.", called,
                                  n, value.substr(0, 40)));
    } else if (!at) {
      notes.push_back(fmt::format("{} has no voxels: its Segment{}_Layer is '{}', a number from 0 on is expected.",
                                  called, n, layer.substr(0, 40)));
    } else if (static_cast<std::size_t>(*at) >= layers) {
      notes.push_back(fmt::format("{} has no voxels: its Segment{}_Layer is {}, and the file's last layer is {}.",
                                  called, n, *at, layers - 1));
    } else {
      segments.push_back({texts.name.value_or(""), *number, static_cast<std::size_t>(*at)});
    }
  }
  return segments;
}

/// The axis that is not a spatial one but counts layers of segments or volumes; -1 = there is none.
int list_axis(const Nrrd& nrrd) {
  if (nrrd.dim != 4) return -1;
  for (const int axis : {0, 3}) {
    if (!std::isfinite(nrrd.axis[axis].spaceDirection[0])) return axis;
  }
  return 3;
}

/// One volume or layer of the file.
Result<NrrdPointer> slice_of(const Nrrd& nrrd, int axis, std::size_t at, const std::string& source) {
  NrrdPointer slice(nrrdNew());
  const int status = axis < 0 ? nrrdCopy(slice.get(), &nrrd) : nrrdSlice(slice.get(), &nrrd, axis, at);
  if (status != 0) {
    return input_error(source, fmt::format("a volume cannot be taken out of the NRRD file ({})", last_error()),
                       "Export one 3D label mask");
  }
  return slice;
}

Result<Voxels> voxels_of(const Nrrd& nrrd, const Vec3& lps, const std::string& source) {
  Result<VoxelType> type = voxel_type(nrrd.type, source);
  if (!type) return type.error();
  Voxels voxels;
  voxels.source = source;
  voxels.type = *type;
  voxels.data = nrrd.data;
  voxels.origin_field = "space origin";
  voxels.spacing_field = "space directions";
  for (unsigned a = 0; a < 3; ++a) {
    const NrrdAxisInfo& axis = nrrd.axis[a];
    const bool no_step = std::isnan(axis.spaceDirection[0]);
    if (no_step || std::isnan(nrrd.spaceOrigin[0])) {
      return input_error(source,
                         fmt::format("the header does not state the position of the image in the patient (no '{}')",
                                     no_step ? "space directions" : "space origin"),
                         "Write 'space', 'space directions' and 'space origin'");
    }
    const double unit = unit_mm(nrrd.spaceUnits[a]);
    if (unit == 0.0) {
      return input_error(source, fmt::format("the unit '{}' is unknown", nrrd.spaceUnits[a]),
                         "Write 'space units: \"mm\" \"mm\" \"mm\"'");
    }
    voxels.size[a] = axis.size;
    for (unsigned row = 0; row < 3; ++row) {
      voxels.axes(row, a) = lps[row] * unit_mm(nrrd.spaceUnits[row]) * axis.spaceDirection[row];
    }
    voxels.origin[a] = lps[a] * unit * nrrd.spaceOrigin[a];
  }
  return voxels;
}

/// Merges the segments of all layers into one image. Labels that the header does not describe become segments without a
/// name. Each layer counts its labels from 1; if two layers share a label, all segments are numbered by their order in
/// the file instead.
/// @param own_volumes each layer is one segment, whatever its values are
Result<LabelImage> merge_layers(const Nrrd& nrrd, int axis, std::vector<SegmentKeys> keys, bool own_volumes,
                                const Vec3& lps, std::span<const std::string> skip, const std::string& source) {
  LabelImage image;
  std::vector<Run> runs;
  for (std::size_t layer = 0; layer < nrrd.axis[axis].size; ++layer) {
    Result<NrrdPointer> slice = slice_of(nrrd, axis, layer, source);
    if (!slice) return slice.error();
    Result<Voxels> voxels = voxels_of(**slice, lps, source);
    if (!voxels) return voxels.error();
    if (layer == 0) {
      if (Result<> frame = set_frame(*voxels, image); !frame) return frame.error();
      image.labels.resize((*voxels).size[0] * (*voxels).size[1] * (*voxels).size[2]);
    }
    Result<std::vector<std::uint16_t>> labels = labels_of(*voxels, image.notes);
    if (!labels) return labels.error();
    std::vector<int> place(std::size_t{1} << 16, -1);  // position in the list, by the segment's value
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (keys[k].layer == layer) place[keys[k].value] = static_cast<int>(k);
    }
    for (std::size_t n = 0; n < labels->size(); ++n) {
      if ((*labels)[n] == 0) continue;
      const std::uint16_t label = own_volumes ? std::uint16_t{1} : (*labels)[n];
      if (place[label] < 0) {
        place[label] = static_cast<int>(keys.size());
        keys.push_back({"", label, layer});
        image.notes.push_back(fmt::format(
            "Label {} of layer {} does not belong to a segment of the header and becomes a segment without a name.",
            label, layer));
      }
      add_voxel(runs, n, place[label]);
    }
  }
  std::set<int> values;
  for (const SegmentKeys& key : keys) values.insert(key.value);
  const bool unique = values.size() == keys.size();
  std::vector<Segment> segments;
  for (const SegmentKeys& key : keys)
    segments.push_back({unique ? key.value : static_cast<int>(segments.size()) + 1, key.name, ""});
  if (own_volumes) {
    image.notes.push_back(fmt::format(
        "{} segments, each a volume of its own, were merged into one mask and numbered 1, 2, … in the order "
        "of the file.",
        segments.size()));
  } else {
    image.notes.push_back(fmt::format(
        "{} segments in {} layers were merged into one mask{}.", segments.size(), nrrd.axis[axis].size,
        unique ? "" : "; since layers use the same labels, segments are numbered 1, 2, … in the order of the file"));
  }
  if (Result<> painted = paint(segments, runs, skip, image); !painted) return painted.error();
  if (Result<> extent = check_extent(image); !extent) return extent.error();
  return image;
}

/// Checks a field that names data files, since Teem would open any file.
Result<> check_data_file(const std::filesystem::path& path, const std::string& name) {
  if (name.starts_with("LIST") || name.find('%') != std::string::npos) {
    return input_error(path.string() + ", data file",
                       fmt::format("'{}': data spread over many files are not supported", name.substr(0, 80)),
                       "Export one .nrrd file");
  }
  if (Result<std::filesystem::path> data = data_file_of(path, name); !data) return data.error();
  return Ok{};
}

/// Checks the header before Teem reads it, because Teem opens any file that a field names, and writes beyond the end of
/// its message buffer if a field has a very long word. A line is a field if its first ": " comes before its first ":=";
/// otherwise it is a key with its value. Free text, which Teem does not take apart, may be as long as that of a key.
Result<> check_header(const std::filesystem::path& path) {
  constexpr std::size_t kLongestField = 512;
  std::ifstream file(path, std::ios::binary);
  for (int number = 1;; ++number) {
    const std::optional<HeaderLine> line = next_header_line(file);
    if (!line || line->text.empty()) return Ok{};  // an empty line ends the header
    const std::string& text = line->text;
    const auto colon = text.find(':');
    const std::string key = lower(trimmed(text.substr(0, colon)));
    const bool field =
        text.front() != '#' && text.find(": ") <= text.find(":=") && key != "content" && key != "sample units";
    const std::size_t most = field ? kLongestField : kLongestHeaderLine;
    if (!line->whole || text.size() > most) {
      return input_error(fmt::format("{}, line {}", path.string(), number),
                         fmt::format("the header has a line of {}{} characters, at most {} are expected",
                                     line->whole ? "" : "more than ", text.size(), most),
                         "The file is damaged; copy or export it again");
    }
    if (colon == std::string::npos || text.front() == '#') continue;
    if (key != "data file" && key != "datafile") continue;
    if (Result<> sound = check_data_file(path, trimmed(text.substr(colon + 1))); !sound) return sound;
  }
}

}  // namespace

Result<LabelImage> parse_nrrd(const std::filesystem::path& path, const MaskReadOptions& options) {
  const std::string source = path.string();
  const auto damaged = [&] {
    return input_error(source, fmt::format("the NRRD file cannot be read ({})", last_error()),
                       "The file is truncated or damaged; copy or export it again");
  };
  if (Result<> header = check_header(path); !header) return header.error();
  // Read the header first, so that an error does not need gigabytes of data to be read, and is more precise.
  const std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)> header_only(nrrdIoStateNew(), nrrdIoStateNix);
  nrrdIoStateSet(header_only.get(), nrrdIoStateSkipData, AIR_TRUE);
  NrrdPointer nrrd(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), header_only.get()) != 0) return damaged();
  if (nrrd->dim > 4) {
    return input_error(source + ", dimension", fmt::format("the value is {}, 3 or 4 is expected", nrrd->dim),
                       "Export one 3D label mask, or volumes along a fourth axis only");
  }
  const int axis = list_axis(*nrrd);
  std::vector<std::size_t> sizes;
  for (unsigned d = 0; d < nrrd->dim; ++d) {
    if (static_cast<int>(d) != axis) sizes.push_back(nrrd->axis[d].size);
  }
  if (axis >= 0) sizes.push_back(nrrd->axis[axis].size);
  std::vector<std::string> notes;
  const std::map<int, SegmentTexts> described_segments = segment_texts(*nrrd);
  const bool own_volumes = axis >= 0 && has_volume_for_each(described_segments);
  const std::vector<SegmentKeys> keys =
      segment_keys(described_segments, axis < 0 ? 1 : nrrd->axis[axis].size, own_volumes, notes);
  const bool described = !keys.empty() || !notes.empty();
  const bool layered = axis >= 0 && nrrd->axis[axis].size > 1 && described && options.volume == 0;
  Result<std::size_t> volume =
      choose_volume(layered ? std::span(sizes).first(3) : std::span(sizes), options.volume, source);
  if (!volume) return volume.error();
  Result<Vec3> lps = to_lps(*nrrd, source);
  if (!lps) return lps.error();

  nrrd.reset(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), nullptr) != 0) return damaged();
  const auto with_notes = [&](LabelImage image) {
    image.notes.insert(image.notes.begin(), notes.begin(), notes.end());
    return image;
  };
  if (layered) {
    Result<LabelImage> merged = merge_layers(*nrrd, axis, keys, own_volumes, *lps, options.skip, source);
    return merged ? with_notes(std::move(*merged)) : std::move(merged);
  }
  Result<NrrdPointer> slice = slice_of(*nrrd, axis, *volume, source);
  if (!slice) return slice.error();
  Result<Voxels> voxels = voxels_of(**slice, *lps, source);
  if (!voxels) return voxels.error();
  Result<LabelImage> image = to_label_image(*voxels);
  if (!image) return image;
  for (const SegmentKeys& key : keys) {
    if (!key.name.empty() && (axis < 0 || key.layer == *volume)) image->names[key.value] = key.name;
  }
  return with_notes(std::move(*image));
}

}  // namespace stylet::detail
