// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stylet::meshing {

namespace {

constexpr double kOffsetRoom = 4.0;  // [mm] largest offset of a surface for which the boxes leave room

/// Whether an overlap of two structures is normal: anything may lie in the body, in a band or in fat, urethra and zones
/// lie in the gland, and the lumen lies in the rectum.
bool belongs_inside(const Structure& inner, const Structure& outer) {
  return outer.name == "body" || outer.name == "band" || outer.name.ends_with("_fat") ||
         (outer.target && (inner.target || inner.name == "urethra")) ||
         (outer.name == "rectum" && inner.name == "rectal_lumen");
}

}  // namespace

int priority(std::string_view c) {
  constexpr std::array<std::string_view, 23> order{"urethra",
                                                   "anterior_stroma",
                                                   "central_zone",
                                                   "transition_zone",
                                                   "peripheral_zone",
                                                   "prostate",
                                                   "ctv",
                                                   "target",
                                                   "gtv",
                                                   "ptv",
                                                   "seminal_vesicles",
                                                   "bladder",
                                                   "rectal_lumen",
                                                   "rectum",
                                                   "pubic_arch",
                                                   "femur_left",
                                                   "femur_right",
                                                   "",
                                                   "band",
                                                   "periprostatic_fat",
                                                   "levator",
                                                   "ischiorectal_fat",
                                                   "subcutaneous_fat"};
  if (c == "body") return static_cast<int>(order.size());
  const auto it = std::find(order.begin(), order.end(), c);
  // Regions that the user named come after the known organs.
  return static_cast<int>((it == order.end() ? std::find(order.begin(), order.end(), "") : it) - order.begin());
}

void Anatomy::add(Structure structure) {
  ShapePtr solid = structure.shape;
  add(std::move(solid), {std::move(structure)});
}

void Anatomy::add(ShapePtr solid, std::vector<Structure> members) {
  Layer layer;
  layer.solid = std::move(solid);
  layer.box = layer.solid->box();
  layer.box.min().array() -= kOffsetRoom;
  layer.box.max().array() += kOffsetRoom;
  for (Structure& s : members) {
    layer.members.push_back(static_cast<int>(structures.size()));
    structures.push_back(std::move(s));
  }
  layers.push_back(std::move(layer));
}

int Anatomy::member(const Layer& layer, const Vec3& p) const {
  if (layer.members.size() == 1) return layer.members[0];
  int best = layer.members[0];
  double deepest = HUGE_VAL;
  for (const int m : layer.members) {
    const double d = structures[m].shape->distance(p) - structures[m].offset;
    if (d < deepest) {
      deepest = d;
      best = m;
    }
  }
  return best;
}

int Anatomy::label(const Vec3& p) const {
  for (const Layer& layer : layers) {
    if (!layer.box.contains(p) || layer.solid->distance(p) >= layer.offset) continue;
    if (layer.clipped && layers.back().solid->distance(p) >= layers.back().offset) continue;
    return 1 + member(layer, p);
  }
  return 0;
}

int Anatomy::layer_of(int label) const {
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const auto& m = layers[l].members;
    if (std::find(m.begin(), m.end(), label - 1) != m.end()) return static_cast<int>(l);
  }
  return -1;
}

double Anatomy::interface_distance(int a, int b, const Vec3& p) const {
  const auto surface = [&](const Layer& layer) { return layer.solid->distance(p) - layer.offset; };
  const int la = a > 0 ? layer_of(a) : -1;
  const int lb = b > 0 ? layer_of(b) : -1;
  if (la >= 0 && la == lb) {
    const auto depth = [&](int label) {
      return structures[label - 1].shape->distance(p) - structures[label - 1].offset;
    };
    return 0.5 * (depth(a) - depth(b));
  }
  if (la < 0 || lb < 0) {
    const Layer& own = layers[std::max(la, lb)];
    return surface(own.clipped ? layers.back() : own);
  }
  return surface(layers[std::min(la, lb)]);
}

double Anatomy::distance_to(int structure, const Vec3& p) const {
  const auto to = [&](const Layer& layer) {
    const double whole = layer.solid->distance(p) - layer.offset;
    return layer.clipped ? std::max(whole, layers.back().solid->distance(p) - layers.back().offset) : whole;
  };
  const Structure& own = structures[static_cast<std::size_t>(structure)];
  const auto place = static_cast<std::size_t>(layer_of(structure + 1));
  double distance = to(layers[place]);
  for (std::size_t higher = 0; higher < place; ++higher) {
    const Structure& taker = structures[static_cast<std::size_t>(layers[higher].members[0])];
    if (layers[higher].box.contains(p) && !own.generated && !belongs_inside(taker, own))
      distance = std::max(distance, -to(layers[higher]));
  }
  for (const int other : layers[place].members) {
    if (other != structure) distance = std::max(distance, interface_distance(structure + 1, other + 1, p));
  }
  return distance;
}

Vec3 Anatomy::project(int a, int b, Vec3 p) const {
  constexpr double kStep = 0.2;  // [mm] step for the gradient; with a smaller one, kinks of the grid would matter
  for (int i = 0; i < 3; ++i) {
    const double d = interface_distance(a, b, p);
    if (std::abs(d) < 1e-4) break;
    Vec3 gradient;
    for (int c = 0; c < 3; ++c) {
      const Vec3 e = kStep * Vec3::Unit(c);
      gradient[c] = (interface_distance(a, b, p + e) - interface_distance(a, b, p - e)) / (2 * kStep);
    }
    if (!(gradient.squaredNorm() > 0.01)) break;
    p -= d / gradient.squaredNorm() * gradient;
  }
  return p;
}

Eigen::AlignedBox3d Anatomy::box() const {
  Eigen::AlignedBox3d all;
  for (const Layer& layer : layers) all.extend(layer.box);
  return all;
}

double Anatomy::target_distance(const Vec3& p) const {
  double d = HUGE_VAL;
  for (const Structure& s : structures) {
    if (s.target) d = std::min(d, s.shape->distance(p) - s.offset);
  }
  return d;
}

Eigen::AlignedBox3d Anatomy::target_box() const {
  Eigen::AlignedBox3d box;
  for (const Structure& s : structures) {
    if (s.target) box.extend(s.shape->box());
  }
  return box;
}

const Structure* Anatomy::find(std::string_view name) const {
  for (const Structure& s : structures) {
    if (s.name == name) return &s;
  }
  return nullptr;
}

namespace {

/// Offset with which the shape has a given volume [mm³], found by bisection within ± 3 mm; 0 when there is none.
double offset_for_volume(const Shape& shape, double volume) {
  double low = -std::min(3.0, 0.9 * shape.inner_radius());
  double high = 3.0;
  if (shape.volume(low) > volume || shape.volume(high) < volume) return 0;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (shape.volume(middle) < volume ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

void settle_overlaps(Anatomy& a) {
  for (Layer& layer : a.layers) {
    double volume = 0;
    for (const int m : layer.members) volume += a.structures[m].input_volume;
    if (!(volume > 0)) continue;
    layer.offset = offset_for_volume(*layer.solid, volume);
    if (layer.members.size() == 1) a.structures[layer.members[0]].offset = layer.offset;
  }
  // For each solid, compute the share that structures of higher priority take, on the solid's own grid.
  for (std::size_t l = 0; l < a.layers.size(); ++l) {
    const Layer& layer = a.layers[l];
    const auto* grid = dynamic_cast<const GridShape*>(layer.solid.get());
    if (grid == nullptr) continue;
    std::vector<double> own(a.structures.size(), 0), all(a.structures.size(), 0);
    std::vector<double> taken(a.structures.size(), 0);
    const double width = grid->spacing.mean();
    for (int k = 0; k < grid->size[2]; ++k) {
      for (int j = 0; j < grid->size[1]; ++j) {
        for (int i = 0; i < grid->size[0]; ++i) {
          const double d = grid->values[grid->at(i, j, k)] - layer.offset;
          const double inside = std::clamp(0.5 - d / width, 0.0, 1.0);
          if (inside == 0) continue;
          const Vec3 p = grid->node(i, j, k);
          const int m = a.member(layer, p);
          all[m] += inside;
          double lost = 0;
          int by = -1;
          for (std::size_t h = 0; h < l; ++h) {
            const Layer& higher = a.layers[h];
            if (!higher.box.contains(p)) continue;
            const double part = std::clamp(0.5 - (higher.solid->distance(p) - higher.offset) / width, 0.0, 1.0);
            if (part > lost) {
              lost = part;
              by = a.member(higher, p);
            }
          }
          lost = std::min(lost, inside);
          own[m] += inside - lost;
          if (by >= 0) taken[by] += lost;
        }
      }
    }
    for (const int m : layer.members) {
      Structure& s = a.structures[m];
      if (all[m] > 0) s.input_volume *= own[m] / all[m];
    }
    const std::string& name = a.structures[layer.members[0]].name;
    for (std::size_t h = 0; h < a.structures.size(); ++h) {
      const double cc = taken[h] * grid->spacing.prod() / 1000;
      const double smaller = std::min(a.structures[h].input_volume, layer.solid->volume(layer.offset)) / 1000;
      if (belongs_inside(a.structures[h], a.structures[layer.members[0]])) continue;
      if (!(cc > 0.01 * smaller) || cc < 0.005) continue;
      a.notes.push_back(fmt::format("The structures '{}' and '{}' overlap by {:.2f} cc; the overlap is meshed as '{}'.",
                                    a.structures[h].name, name, cc, a.structures[h].name));
    }
  }
}

}  // namespace stylet::meshing
