// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit_structures.hpp"

#include "stylet/dose/structure_samples.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/geom/structure_names.hpp"
#include "stylet/mesher/body_parts.hpp"
#include "stylet/mesher/structures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet::fit {

namespace {

constexpr double kSteps = 24.0;           // samples along the longest side of a structure
constexpr std::size_t kMostPoints = 800;  // kept for distances between structures
constexpr const char* kSkippedByUser = "named in [patient] skip";

bool says_prostate(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower.find("prost") != std::string::npos;
}

bool is_planning_volume(std::string_view region) {
  return region == "ctv" || region == "ptv" || region == "gtv" || region == "target";
}

/// Every k-th of the points, so that few enough are left.
std::vector<Vec3> thinned(const std::vector<Vec3>& points) {
  const std::size_t stride = 1 + points.size() / kMostPoints;
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < points.size(); k += stride) kept.push_back(points[k]);
  return kept;
}

/// Name and region of a structure, without its measures.
/// @param word another word by which the user may name it
Structure named(const StructureUse& use, const std::string& word, const MeshOptions& names) {
  Structure s{.name = use.name, .region = use.region};
  const std::string by_name = canonical_region(use.name);
  for (const auto& [key, region] : names.regions) {
    if (is_listed(use.name, std::vector{key}) || word == key) s.insisted = true;
  }
  s.guessed = !s.insisted && is_target_region(use.region) && !says_prostate(use.name) &&
              (is_planning_volume(by_name) || use.why.starts_with("taken as the gland"));
  if (s.region.empty() && !is_target_region(by_name)) s.region = by_name;  // an organ that the preset leaves out
  return s;
}

/// Measures the volume of contours by sampling them, as `stylet dose` does.
void measure(const Roi& roi, Structure& s) {
  for (const Contour& contour : roi.contours) {
    for (const Vec3& p : contour.points) s.box.extend(p);
  }
  if (s.region.empty() || s.box.isEmpty() || s.box.sizes().maxCoeff() <= 0.0) return;
  s.step_mm = s.box.sizes().maxCoeff() / kSteps;
  const auto samples = sample_structure(roi, s.step_mm);
  if (!samples || samples->points.empty()) return;
  s.volume_cc = samples->volume_cc();
  // All samples of the body are kept: a point of the gland is in the body if one of them is near.
  s.points = s.region == "body" ? samples->points : thinned(samples->points);
}

Structures read(const ContourSet& contours, const MeshOptions& names) {
  Structures out{.kind = "structure"};
  const auto choice = choose_structures(contours, names);
  if (!choice) return out;
  auto use = choice->uses.begin();
  for (const Roi& roi : contours.rois) {
    if (roi.contours.empty()) continue;
    out.all.push_back(named(*use++, "", names));
    measure(roi, out.all.back());
  }
  for (const StructureUse& empty : choice->empty) {
    if (empty.why == kSkippedByUser) out.all.push_back(named(empty, "", names));
  }
  return out;
}

Structures read(const LabelImage& image, const MeshOptions& names) {
  Structures out{.kind = "label", .apart = true};
  const auto choice = choose_structures(image, names);
  if (!choice) return out;
  std::map<int, std::size_t> place, voxels;
  for (const StructureUse& use : choice->uses) {
    place[use.number] = out.all.size();
    Structure s = named(use, std::to_string(use.number), names);
    const auto meaning = image.meanings.find(use.number);
    if (canonical_region(s.region).empty() && meaning != image.meanings.end() && body_part(s.name) == BodyPart::none)
      s.name = meaning->second;
    out.all.push_back(std::move(s));
  }
  for (const int label : image.labels) ++voxels[label];
  std::map<int, std::size_t> seen;
  std::size_t voxel = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i, ++voxel) {
        const int label = image.labels[voxel];
        const auto found = label == 0 ? place.end() : place.find(label);
        if (found == place.end()) continue;
        const Vec3 centre = image.voxel_centre(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        Structure& s = out.all[found->second];
        s.box.extend(centre);
        if (seen[label]++ % (1 + voxels[label] / kMostPoints) == 0) s.points.push_back(centre);
      }
    }
  }
  for (const auto& [label, at] : place)
    out.all[at].volume_cc = static_cast<double>(voxels[label]) * std::abs(image.spacing.prod()) / 1000.0;
  return out;
}

Structures read(const TetMesh& mesh, const MeshOptions& names) {
  Structures out{.kind = "region", .apart = true, .has_unit = true};
  for (const std::string& name : mesh.regions) {
    StructureUse use{.name = name, .region = canonical_region(name)};
    for (const auto& [key, region] : names.regions) {
      if (!find_region(std::vector{name}, key).empty()) use.region = region_meant(region);
    }
    if (use.region.empty() && name.starts_with("label_")) use.region = name;
    const std::string number = name.starts_with("region ") ? name.substr(7) : "";
    out.all.push_back(named(use, number, names));
  }
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    Structure& s = out.all[static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(t)])];
    Vec3 centre = Vec3::Zero();
    for (const Index node : mesh.tets[static_cast<std::size_t>(t)]) {
      const Vec3& p = mesh.nodes[static_cast<std::size_t>(node)];
      s.box.extend(p);
      centre += 0.25 * p;
    }
    s.volume_cc += std::abs(tet_volume(mesh, t)) / 1000.0;
    s.points.push_back(centre);
  }
  for (Structure& s : out.all) s.points = thinned(s.points);
  return out;
}

Structures read(const std::vector<Surface>&, const MeshOptions&) { return {}; }

}  // namespace

Vec3 Structure::centre() const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

double Structure::spacing_mm() const {
  return std::cbrt(1000.0 * volume_cc / static_cast<double>(std::max<std::size_t>(1, points.size())));
}

Structures structures_of(const PatientInput& input, const MeshOptions& names) {
  return std::visit([&](const auto& content) { return read(content, names); }, input);
}

}  // namespace stylet::fit
