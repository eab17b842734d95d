// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/region_views.hpp"

#include "stylet/geom/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

namespace stylet::results {
namespace {

// Okabe & Ito, "Color universal design", 2008.
constexpr Colour kOrange{0.902, 0.624, 0.000}, kSkyBlue{0.337, 0.706, 0.914}, kGreen{0.000, 0.620, 0.451},
    kYellow{0.941, 0.894, 0.259}, kBlue{0.000, 0.447, 0.698}, kVermillion{0.835, 0.369, 0.000},
    kPurple{0.800, 0.475, 0.655};
constexpr Colour kBone{0.66, 0.66, 0.63}, kFlesh{0.80, 0.74, 0.68};
constexpr Colour kMuscle{0.72, 0.36, 0.33};
// Layers of fat are shades of one tissue, light to dark. Of these, no two organs look alike with any colour vision.
constexpr Colour kLightFat{0.98, 0.95, 0.82}, kFat{0.70, 0.60, 0.36}, kDarkFat{0.45, 0.33, 0.12};

struct Custom {
  std::string_view part_of_name;
  Colour colour;
};

/// Fixed colours of organs, so that they look the same in all reports; other regions get the remaining colours in turn.
constexpr std::array kCustoms{Custom{"prostate", kOrange},     Custom{"urethra", kYellow}, Custom{"bladder", kSkyBlue},
                              Custom{"rectum", kPurple},       Custom{"seminal", kGreen},  Custom{"pubic", kBone},
                              Custom{"bone", kBone},           Custom{"femur", kBone},     Custom{"band", kVermillion},
                              Custom{"ligament", kVermillion}, Custom{"body", kFlesh},     Custom{"skin", kFlesh},
                              Custom{"subcut", kLightFat},     Custom{"ischio", kDarkFat}, Custom{"fat", kFat},
                              Custom{"fat", kLightFat},        Custom{"fat", kDarkFat},    Custom{"levator", kMuscle},
                              Custom{"lumen", kBone}};
/// The two blues are last, so that they stand beside each other only where nothing else is left.
constexpr std::array kFree{kOrange, kGreen, kVermillion, kPurple, kYellow, kSkyBlue, kBlue};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

double area(const TetMesh& mesh, const std::array<Index, 3>& face) {
  const auto at = [&](int k) -> const Vec3& { return mesh.nodes[static_cast<std::size_t>(face[k])]; };
  return 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
}

std::array<Index, 3> flipped(const std::array<Index, 3>& face) { return {face[0], face[2], face[1]}; }

bool is_soft_layer(const std::string& name) { return name.ends_with("_fat") || name == "levator"; }

/// Areas of contact between regions.
struct Contacts {
  MatX shared;  ///< (r × r) [mm²] area of the surface between two regions
  VecX outer;   ///< (r) [mm²] area of a region's surface on the outside of the mesh
  VecX volume;  ///< (r) [mm³]

  Contacts(const TetMesh& mesh, const Topology& topology) {
    const auto count = static_cast<Eigen::Index>(mesh.regions.size());
    shared = MatX::Zero(count, count);
    outer = VecX::Zero(count);
    volume = VecX::Zero(count);
    const auto region = [&](Index t) { return mesh.tet_region[static_cast<std::size_t>(t)]; };
    for (const Face& f : topology.boundary) outer[region(f.tet)] += area(mesh, f.nodes);
    for (const Face& f : topology.interfaces) {
      const double a = area(mesh, f.nodes);
      shared(region(f.tet), region(f.neighbour)) += a;
      shared(region(f.neighbour), region(f.tet)) += a;
    }
    for (Index t = 0; t < mesh.tet_count(); ++t) volume[region(t)] += tet_volume(mesh, t);
  }

  /// Whether a region lies in a larger one: more than a third of its surface is in contact with the larger one.
  [[nodiscard]] bool lies_in(int inner, int around) const {
    const double surface = outer[inner] + shared.row(inner).sum();
    return volume[inner] < volume[around] && shared(inner, around) > surface / 3;
  }

  /// The region with the largest outer surface, if another region lies in it.
  [[nodiscard]] int background() const {
    Eigen::Index most = 0;
    if (outer.maxCoeff(&most) <= 0) return -1;
    for (int r = 0; r < static_cast<int>(outer.size()); ++r) {
      if (r != most && lies_in(r, static_cast<int>(most))) return static_cast<int>(most);
    }
    return -1;
  }
};

}  // namespace

std::string hex(const Colour& colour) {
  const auto byte = [](double share) { return static_cast<int>(std::lround(255.0 * share)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour[0]), byte(colour[1]), byte(colour[2]));
}

std::string readable_name(const std::string& name) {
  if (name == "ptv" || name == "ctv" || name == "gtv") {  // abbreviations of planning volumes
    std::string initials = name;
    for (char& c : initials) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return initials;
  }
  std::string text = name;
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::vector<RegionView> region_views(const TetMesh& mesh, std::span<const int> targets) {
  const Topology topology(mesh);
  const Contacts contacts(mesh, topology);
  const int background = contacts.background();
  std::vector<RegionView> views(mesh.regions.size());
  std::vector<bool> taken(kFree.size(), false);
  const auto take = [&](const Colour& colour) {
    const auto place = std::find(kFree.begin(), kFree.end(), colour);
    if (place != kFree.end()) taken[static_cast<std::size_t>(place - kFree.begin())] = true;
    return colour;
  };

  std::vector<bool> coloured(views.size(), false);
  for (std::size_t r = 0; r < views.size(); ++r) {
    RegionView& view = views[r];
    view.region = static_cast<int>(r);
    view.name = mesh.regions[r];
    view.label = readable_name(view.name);
    view.target = std::find(targets.begin(), targets.end(), view.region) != targets.end();
    view.background = view.region == background;
    view.soft_layer = is_soft_layer(view.name);
    view.opacity = view.background ? 0.10 : view.soft_layer ? 0.14 : view.target ? 0.75 : 0.48;
    if (view.background) {
      view.colour = kFlesh;
      coloured[r] = true;
      continue;
    }
    for (const Custom& custom : kCustoms) {
      const bool first = std::none_of(views.begin(), views.begin() + static_cast<std::ptrdiff_t>(r),
                                      [&](const RegionView& v) { return !v.background && v.colour == custom.colour; });
      if (lower(view.name).find(custom.part_of_name) != std::string::npos && (first || custom.colour == kBone)) {
        view.colour = take(custom.colour);
        coloured[r] = true;
        break;
      }
    }
  }
  for (std::size_t r = 0; r < views.size(); ++r) {
    if (coloured[r]) continue;
    const auto place = std::find(taken.begin(), taken.end(), false);
    views[r].colour =
        place != taken.end() ? take(kFree[static_cast<std::size_t>(place - taken.begin())]) : kFree[r % kFree.size()];
  }

  const auto region = [&](Index t) { return mesh.tet_region[static_cast<std::size_t>(t)]; };
  for (const Face& f : topology.boundary) views[static_cast<std::size_t>(region(f.tet))].triangles.push_back(f.nodes);
  for (const Face& f : topology.interfaces) {
    const int a = region(f.tet), b = region(f.neighbour);
    if (!contacts.lies_in(b, a) && a != background) views[static_cast<std::size_t>(a)].triangles.push_back(f.nodes);
    if (!contacts.lies_in(a, b) && b != background) {
      views[static_cast<std::size_t>(b)].triangles.push_back(flipped(f.nodes));
    }
  }
  std::erase_if(views, [&](const RegionView& v) { return contacts.volume[v.region] == 0; });
  return views;
}

}  // namespace stylet::results
