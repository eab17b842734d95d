// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the soft layers that contours and masks lack.
#include "stylet/geom/soft_layers.hpp"

#include "anatomy.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace stylet::meshing {
namespace {

constexpr double kLevatorTop = 0.25;       // top of the muscle below the gland's base / height of the gland
constexpr double kFossaTop = 12.0;         // [mm] top of the ischiorectal fat above the apex
constexpr double kFossaDepth = 50.0;       // [mm] extent of the ischiorectal fat from front to back
constexpr double kBehindGland = 15.0;      // [mm] distance of a rectum that the input lacks behind the gland
constexpr double kRectumHalfWidth = 15.0;  // [mm] half width of such a rectum
// [mm] the layer under the skin ends this far above the lowest skin plus its thickness.
constexpr double kFatEnd = 20.0;

using Distance = std::function<double(const Vec3&)>;

/// A solid whose distance is given by a function.
class MadeShape : public Shape {
 public:
  MadeShape(Distance distance, const Eigen::AlignedBox3d& box, double thickness)
      : distance_(std::move(distance)), box_(box), thickness_(thickness) {}
  [[nodiscard]] double distance(const Vec3& p) const override { return distance_(p); }
  [[nodiscard]] Eigen::AlignedBox3d box() const override { return box_; }
  [[nodiscard]] double volume(double) const override { return std::numeric_limits<double>::quiet_NaN(); }
  /// Half the thickness would make elements finer than needed: the layer yields as a whole.
  [[nodiscard]] double inner_radius() const override { return thickness_; }

 private:
  Distance distance_;
  Eigen::AlignedBox3d box_;
  double thickness_;
};

/// Union of several structures.
class Solid {
 public:
  void take(const Structure& s) {
    parts_.emplace_back(s.shape, s.offset);
    box_.extend(s.shape->box());
  }
  [[nodiscard]] bool is_any() const { return !parts_.empty(); }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }
  [[nodiscard]] double distance(const Vec3& p) const {
    double d = HUGE_VAL;
    for (const auto& [shape, offset] : parts_) d = std::min(d, shape->distance(p) - offset);
    return d;
  }

 private:
  std::vector<std::pair<ShapePtr, double>> parts_;
  Eigen::AlignedBox3d box_;
};

Eigen::AlignedBox3d grown(Eigen::AlignedBox3d box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

/// Adds the soft layers to an anatomy, the innermost first.
class LayerMaker {
 public:
  LayerMaker(Anatomy& anatomy, const SoftLayers& layers) : a_(anatomy), layers_(layers) {
    for (const Structure& s : a_.structures) {
      if (s.target) gland_.take(s);
      if (s.target || s.name == "seminal_vesicles") wrapped_.take(s);
      if (s.name == "rectum") rectum_.take(s);
      if (s.name == "body") body_.take(s);
    }
  }

  void make() {
    if (!gland_.is_any()) return;
    rectal_lumen();
    periprostatic_fat();
    levator();
    ischiorectal_fat();
    subcutaneous_fat();
    if (!made_.empty()) {
      a_.notes.push_back(
          fmt::format("Soft tissue that the input does not have was added: {}.", fmt::join(made_, ", ")));
    }
  }

 private:
  [[nodiscard]] bool wanted(const char* name, double size) const { return size > 0 && a_.find(name) == nullptr; }

  /// Adds a layer to which all structures of the input are preferred.
  void add(const char* name, const std::string& said, Distance distance, const Eigen::AlignedBox3d& box,
           double thickness) {
    Structure s;
    s.name = name;
    s.generated = true;
    s.shape = std::make_shared<MadeShape>(std::move(distance), box, thickness);
    Layer body = std::move(a_.layers.back());
    a_.layers.pop_back();
    a_.add(std::move(s));
    a_.layers.back().clipped = true;
    a_.layers.push_back(std::move(body));
    made_.push_back(said);
  }

  void rectal_lumen() {
    if (!rectum_.is_any() || !wanted("rectal_lumen", layers_.rectal_wall_mm)) return;
    const double wall = layers_.rectal_wall_mm;
    Structure* rectum = nullptr;
    for (Structure& s : a_.structures) {
      if (s.name == "rectum") rectum = &s;
    }
    const double depth = rectum->shape->inner_radius() + rectum->offset;
    if (depth < 1.5 * wall) {
      a_.notes.push_back(fmt::format(
          "The rectum is meshed as one region: it is {:.1f} mm thick, too thin for a wall of {:g} mm and a lumen.",
          2 * depth, wall));
      return;
    }
    const double whole = rectum->shape->volume(rectum->offset);
    const double lumen = rectum->shape->volume(rectum->offset - wall);
    if (whole > 0) rectum->input_volume *= 1 - lumen / whole;
    Structure s;
    s.name = "rectal_lumen";
    s.generated = true;
    s.shape = std::make_shared<MadeShape>([solid = rectum_, wall](const Vec3& p) { return solid.distance(p) + wall; },
                                          rectum_.box(), 0.5 * depth);
    const int own = a_.layer_of(1 + static_cast<int>(rectum - a_.structures.data()));
    a_.add(std::move(s));
    std::rotate(a_.layers.begin() + own, a_.layers.end() - 1, a_.layers.end());
    made_.push_back(fmt::format("rectal lumen in a wall of {:g} mm", wall));
  }

  void periprostatic_fat() {
    const double thickness = layers_.periprostatic_fat_mm;
    if (!wanted("periprostatic_fat", thickness)) return;
    add(
        "periprostatic_fat", fmt::format("{:g} mm of fat around the gland", thickness),
        [solid = wrapped_, thickness](const Vec3& p) { return solid.distance(p) - thickness; },
        grown(wrapped_.box(), thickness), thickness);
  }

  /// A funnel around the gland, its fat and the rectum, open at its upper end.
  void levator() {
    const double thickness = layers_.levator_mm;
    if (!wanted("levator", thickness)) return;
    const double fat = a_.find("periprostatic_fat") != nullptr ? layers_.periprostatic_fat_mm : 0.0;
    const Eigen::AlignedBox3d gland = gland_.box();
    const double top = gland.max().z() - kLevatorTop * gland.sizes().z();
    Solid tube = rectum_;
    Eigen::AlignedBox3d box = grown(gland, fat + thickness);
    if (tube.is_any()) box.extend(grown(tube.box(), thickness));
    box.max().z() = top;
    add(
        "levator", fmt::format("{:g} mm of levator muscle", thickness),
        [gland = gland_, tube, fat, thickness, top](const Vec3& p) {
          const double round = std::min(gland.distance(p) - fat, tube.distance(p)) - thickness;
          return std::max(round, p.z() - top);
        },
        box, thickness);
  }

  /// Two bodies of fat beside the rectum, from the layer under the skin to above the apex.
  void ischiorectal_fat() {
    const double width = layers_.ischiorectal_fat_mm;
    if (!wanted("ischiorectal_fat", width)) return;
    const Eigen::AlignedBox3d gland = gland_.box();
    const double apex = gland.min().z();
    const double skin = skin_below(gland.center());
    const double top = apex + kFossaTop;
    Vec3 middle(gland.center().x(), gland.max().y() + kBehindGland, 0.5 * (skin + top));
    double half = kRectumHalfWidth;
    if (rectum_.is_any()) {
      // The fat lies beside the widest part of the rectum where it passes the apex.
      Eigen::AlignedBox3d cut;
      const Eigen::AlignedBox3d box = rectum_.box();
      for (double x = box.min().x(); x <= box.max().x(); x += 1.0) {
        for (double y = box.min().y(); y <= box.max().y(); y += 1.0) {
          const Vec3 p(x, y, std::max(apex, box.min().z() + 1.0));
          if (rectum_.distance(p) < 0) cut.extend(p);
        }
      }
      if (!cut.isEmpty()) {
        middle.x() = cut.center().x();
        middle.y() = cut.center().y();
        half = 0.5 * cut.sizes().x();
      }
    }
    const double aside = half + layers_.levator_mm + 0.5 * width;
    const Vec3 half_axes(0.5 * width, 0.5 * kFossaDepth, 0.5 * (top - skin));
    if (!(half_axes.z() > 5)) return;
    const Superquadric left(middle + aside * Vec3::UnitX(), half_axes);
    const Superquadric right(middle - aside * Vec3::UnitX(), half_axes);
    Eigen::AlignedBox3d box = left.box();
    box.extend(right.box());
    add(
        "ischiorectal_fat", fmt::format("{:g} mm of ischiorectal fat on either side", width),
        [left, right, body = body_, skin_layer = layers_.subcutaneous_fat_mm](const Vec3& p) {
          const double above_skin = body.distance(p - skin_layer * Vec3::UnitZ());
          return std::max(std::min(left.distance(p), right.distance(p)), above_skin);
        },
        box, 0.5 * width);
  }

  /// Tissue that is less than the thickness above the skin, measured along the patient's axis.
  void subcutaneous_fat() {
    const double thickness = layers_.subcutaneous_fat_mm;
    if (!wanted("subcutaneous_fat", thickness)) return;
    const double skin = skin_below(gland_.box().center());
    const double end = skin + thickness + kFatEnd;
    Eigen::AlignedBox3d box = body_.box();
    box.max().z() = end;
    add(
        "subcutaneous_fat", fmt::format("{:g} mm of fat under the perineal skin", thickness),
        [body = body_, thickness, end](const Vec3& p) {
          return std::max(-body.distance(p - thickness * Vec3::UnitZ()), p.z() - end);
        },
        box, thickness);
  }

  /// z [mm] of the lowest point of the body below a point.
  [[nodiscard]] double skin_below(Vec3 p) const {
    const double bottom = body_.box().min().z() - 1.0;
    double outside = bottom;
    for (p.z() = bottom; p.z() < gland_.box().center().z(); p.z() += 0.5) {
      if (body_.distance(p) < 0) break;
      outside = p.z();
    }
    return outside;
  }

  Anatomy& a_;
  const SoftLayers& layers_;
  Solid gland_, wrapped_, rectum_, body_;
  std::vector<std::string> made_;
};

}  // namespace

void add_soft_layers(Anatomy& anatomy, const SoftLayers& layers) { LayerMaker(anatomy, layers).make(); }

}  // namespace stylet::meshing
