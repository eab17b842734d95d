// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"
#include "body.hpp"
#include "islands.hpp"
#include "stylet/mesher/structures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>

namespace stylet::meshing {
namespace {

/// The image with its slice axis last.
struct Slices {
  std::array<int, 3> axis{0, 1, 2};  ///< axes of the image used as u, v, n
  std::array<int, 3> low{};          ///< first voxel of the part that is not background, including a margin
  std::array<int, 3> size{};         ///< number of voxels of that part
  SliceFrame frame;
  Vec3 spacing;
};

Result<Slices> slices_of(const LabelImage& image, const std::string& where) {
  const std::size_t voxels = static_cast<std::size_t>(image.size[0]) * image.size[1] * image.size[2];
  if (voxels == 0 || image.labels.size() != voxels) {
    return input_error(
        where, fmt::format("it has {} labels for {} voxels, expected one label per voxel", image.labels.size(), voxels),
        "Export it again");
  }
  if (!(image.spacing.minCoeff() > 0) || !image.spacing.allFinite() || !image.origin.allFinite() ||
      !((image.direction.transpose() * image.direction - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-3)) {
    return input_error(where, "the axes of the image are not perpendicular, or its spacing is not positive",
                       "Resample the mask on a rectangular grid");
  }
  Slices s;
  // Slices are perpendicular to the axis with the widest spacing, or to the last axis when spacings are equal.
  int n = 2;
  for (const int a : {0, 1}) {
    if (image.spacing[a] > 1.2 * image.spacing[n]) n = a;
  }
  s.axis = {n == 0 ? 1 : 0, n == 2 ? 1 : 2, n};
  std::array<int, 3> low{image.size[0], image.size[1], image.size[2]};
  std::array<int, 3> high{-1, -1, -1};
  std::size_t v = 0;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i, ++v) {
        if (image.labels[v] == 0) continue;
        const std::array<int, 3> c{i, j, k};
        for (int a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], c[a]);
          high[a] = std::max(high[a], c[a]);
        }
      }
    }
  }
  if (high[0] < 0)
    return input_error(where, "every voxel is background, expected a labelled structure",
                       "Choose a mask with a labelled structure");
  if (high[n] == low[n]) {
    return input_error(where, "the labels lie in one slice, expected at least 2",
                       "Segment the structures on more slices");
  }
  for (int a = 0; a < 3; ++a) {
    const int image_axis = s.axis[a];
    const int margin = a < 2 ? 2 + static_cast<int>(std::ceil(3.0 / image.spacing[image_axis])) : 0;
    s.low[a] = low[image_axis] - margin;
    s.size[a] = high[image_axis] - low[image_axis] + 1 + 2 * margin;
    s.frame.axes.col(a) = image.direction.col(image_axis);
    s.spacing[a] = image.spacing[image_axis];
  }
  s.frame.origin = image.origin;
  return s;
}

/// In-plane distance fields of the voxels for which `inside` holds.
template <class Inside>
SliceFields fields_of(const LabelImage& image, const Slices& s, Inside&& inside) {
  SliceFields f;
  f.frame = s.frame;
  f.low = Eigen::Vector2d(s.low[0] * s.spacing[0], s.low[1] * s.spacing[1]);
  f.spacing = s.spacing.head<2>();
  f.size = {s.size[0], s.size[1]};
  f.gap = s.spacing[2];
  std::vector<bool> mask(static_cast<std::size_t>(s.size[0]) * s.size[1]);
  for (int k = 0; k < s.size[2]; ++k) {
    for (int j = 0; j < s.size[1]; ++j) {
      for (int i = 0; i < s.size[0]; ++i) {
        std::array<int, 3> c{};
        c[s.axis[0]] = s.low[0] + i;
        c[s.axis[1]] = s.low[1] + j;
        c[s.axis[2]] = s.low[2] + k;
        bool in = true;
        for (int a = 0; a < 3; ++a) in = in && c[a] >= 0 && c[a] < image.size[a];
        if (in) {
          in = inside(image.labels[(static_cast<std::size_t>(c[2]) * image.size[1] + c[1]) * image.size[0] + c[0]]);
        }
        mask[static_cast<std::size_t>(j) * s.size[0] + i] = in;
      }
    }
    f.heights.push_back((s.low[2] + k) * s.spacing[2]);
    f.joins_next.push_back(true);
    f.fields.push_back(mask_distance(mask, s.size[0], s.size[1], s.spacing[0], s.spacing[1]));
  }
  return f;
}

/// A note for the user about a region of plates one slice thick, of which a mesh keeps little; empty if fewer than half
/// of its slices are such plates.
std::string plates_note(const std::string& name, const SliceFields& f) {
  const std::size_t count = f.fields.size();
  const auto filled = [&](std::size_t k) { return k < count && !f.fields[k].empty(); };
  std::size_t slices = 0, alone = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (!filled(k)) continue;
    ++slices;
    if (!filled(k + 1) && (k == 0 || !filled(k - 1))) ++alone;
  }
  if (alone < 2 || 2 * alone < slices) return {};
  return fmt::format(
      "The region '{}' has {} slices, of which {} are plates of one slice: the slices beside them have nothing of it. "
      "The mesh keeps little of such plates. Fill the slices between them.",
      name, slices, alone);
}

/// Points where the smoothed surface crosses pixel rows and columns of the slices.
std::vector<Vec3> boundary_points(const GridShape& g, double offset, const SliceFields& f) {
  std::vector<Vec3> points;
  for (std::size_t s = 0; s < f.heights.size(); ++s) {
    if (f.fields[s].empty()) continue;
    const auto at = [&](int i, int j) {
      return f.frame.lps(Vec3(f.low.x() + i * f.spacing.x(), f.low.y() + j * f.spacing.y(), f.heights[s]));
    };
    for (int j = 0; j + 1 < f.size[1]; ++j) {
      for (int i = 0; i + 1 < f.size[0]; ++i) {
        const Vec3 p = at(i, j);
        const double v = g.distance(p) - offset;
        for (const Vec3& q : {at(i + 1, j), at(i, j + 1)}) {
          const double w = g.distance(q) - offset;
          if ((v < 0) != (w < 0)) points.push_back(p + v / (v - w) * (q - p));
        }
      }
    }
  }
  return points;
}

/// Removes the pieces of the common solid in which no member has a part.
void drop_unclaimed_islands(GridShape& solid, const std::vector<Structure>& members) {
  const Islands islands = find_islands(solid);
  std::vector<bool> keep(islands.volume.size(), false);
  std::size_t n = 0;
  for (int k = 0; k < solid.size[2]; ++k) {
    for (int j = 0; j < solid.size[1]; ++j) {
      for (int i = 0; i < solid.size[0]; ++i, ++n) {
        if (islands.piece[n] < 0 || keep[islands.piece[n]]) continue;
        const Vec3 p = solid.node(i, j, k);
        keep[islands.piece[n]] =
            std::any_of(members.begin(), members.end(), [&](const Structure& m) { return m.shape->distance(p) < 0; });
      }
    }
  }
  keep_islands(solid, islands, keep);
}

}  // namespace

Result<Anatomy> anatomy_of(const LabelImage& image, const MeshOptions& options, const Progress& progress) {
  Anatomy anatomy;
  anatomy.source = image.source.empty() ? "label mask" : image.source;
  anatomy.notes = image.notes;
  auto slices = slices_of(image, anatomy.source);
  if (!slices) return slices.error();
  const Slices& s = *slices;

  std::map<int, std::size_t> voxels;
  for (const auto l : image.labels) {
    if (l != 0) ++voxels[l];
  }
  const auto choice = choose_structures(image, options);
  if (!choice) return choice.error();
  const bool named = choice->has_target;
  if (!named) {
    if (!options.regions.empty()) {
      return input_error(
          anatomy.source, "none of the assigned regions is a target (prostate, a prostate zone, CTV, PTV, GTV)",
          "Name the label of the gland 'prostate', or its zones 'peripheral_zone' and 'transition_zone'");
    }
    anatomy.notes.push_back(
        "No label is named as prostate or prostate zone, so all labels together count as the target.");
  }
  anatomy.notes.insert(anatomy.notes.end(), choice->notes.begin(), choice->notes.end());

  std::map<std::string, std::set<int>> labels;  // region → labels
  for (const StructureUse& use : choice->uses) {
    if (use.region.empty()) continue;
    labels[use.region].insert(use.number);
  }
  if (labels.empty())
    return input_error(anatomy.source, "every label is left out, expected at least one in the mesh",
                       "Remove one of them from [patient] skip");
  const double step = std::max(0.8 * std::min(s.spacing[0], s.spacing[1]), std::min(s.spacing[2], 1.0));
  const double sigma = 0.9 * std::max(s.spacing[0], s.spacing[1]);
  const auto volume_of = [&](const std::set<int>& set) {
    std::size_t count = 0;
    for (const int l : set) count += voxels[l];
    return static_cast<double>(count) * image.spacing.prod();
  };
  // All structures together form one solid without gaps, divided among them. If the input has a body, it is a solid of
  // its own that contains the others.
  std::vector<Structure> members;
  std::set<int> organs;
  std::size_t done = 0;
  for (const auto& [name, set] : labels) {
    report(progress, "interpolating slices", static_cast<double>(done++) / static_cast<double>(labels.size()));
    if (name == "body") continue;
    const SliceFields own = fields_of(image, s, [&](int l) { return set.contains(l); });
    auto shape = interpolate_fields(own, step, sigma);
    if (std::string plates = plates_note(name, own); !plates.empty()) anatomy.notes.push_back(std::move(plates));
    const bool islands = drop_small_islands(*shape, kSmallIsland) > 0;
    if (!(shape->inner_radius() > 0.5 * step)) {
      anatomy.notes.push_back(
          fmt::format("The region '{}' has only {:.2f} cc and is nowhere thicker than a voxel, so it is left out.",
                      name, volume_of(set) / 1000));
      continue;
    }
    if (islands)
      anatomy.notes.push_back(
          fmt::format("Small pieces of '{}' that lie apart from its main part were left out.", name));
    organs.insert(set.begin(), set.end());
    Structure structure;
    structure.name = name;
    structure.target = !named || is_target_region(name);
    structure.input_volume = volume_of(set);
    structure.whole_volume = structure.input_volume;
    structure.boundary = boundary_points(*shape, 0, own);
    structure.shape = std::move(shape);
    members.push_back(std::move(structure));
  }
  if (members.empty()) {
    return input_error(anatomy.source, "no region is thicker than a voxel, so there is nothing to mesh",
                       "Fill the slices between those that are drawn, or export the mask with finer voxels");
  }
  const auto solid = interpolate_fields(fields_of(image, s, [&](int l) { return organs.contains(l); }), step, sigma);
  drop_unclaimed_islands(*solid, members);
  anatomy.add(solid, std::move(members));
  if (labels.contains("body")) {
    // Labels that are left out are tissue of the body, because no part of a patient is empty.
    const SliceFields whole = fields_of(image, s, [](int l) { return l != 0; });
    auto shape = interpolate_fields(whole, std::max(step, 2.0), sigma);
    Structure body;
    body.name = "body";
    body.boundary = boundary_points(*shape, 0, whole);
    std::set<int> all;
    for (const auto& [label, count] : voxels) all.insert(label);
    body.whole_volume = volume_of(all);
    body.input_volume = body.whole_volume * trim_body(*shape, anatomy);
    body.shape = std::move(shape);
    anatomy.add(std::move(body));
  }
  return anatomy;
}

}  // namespace stylet::meshing
