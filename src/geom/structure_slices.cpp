// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/structure_slices.hpp"

#include "geom/contour_plane.hpp"
#include "geom/plane_section.hpp"
#include "geom/self_crossing.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stylet {

namespace {

constexpr double kOnePlane_mm = 0.3;     // contours whose heights differ by less lie in one plane …
constexpr double kOnePlaneShare = 0.25;  // … if that is less than this share of the distance of slices
constexpr double kUsualGap = 1.4;        // a gap of more usual gaps is a wide one
constexpr double kBridgedGaps = 6;       // the widest gap that is bridged, in usual gaps …
constexpr double kBridged_mm = 15;       // … or so wide, if that is more
constexpr double kBridgedOverlap = 0.5;  // share of the smaller section that the sections beside a bridge share
constexpr double kCrossing_mm = 0.05;    // edges of a contour that overlap by less only touch
constexpr double kLoop_mm2 = 1;          // a contour may have loops of this area …
constexpr double kLoopShare = 0.005;     // … or of this share of its own area
constexpr double kLeavesPlane_mm = 0.5;  // contours of different structures may leave the common plane by so much
constexpr double kSmallest_mm = 1;       // a structure of a smaller or larger extent has another unit than mm
constexpr double kLargest_mm = 2000;
constexpr std::size_t kNamedPlaces = 4;  // so many places are named in a note; the others are counted

/// Median of numbers; 0 of none.
double median(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

std::vector<double> gaps_of(const std::vector<double>& heights) {
  std::vector<double> gaps;
  for (std::size_t k = 1; k < heights.size(); ++k) gaps.push_back(heights[k] - heights[k - 1]);
  return gaps;
}

/// Heights that differ by less than this lie in one plane [mm]. The distance of slices is the gap up to which the gaps
/// make half of the stack's height: planes that are written twice, a little apart, have many small gaps beside it.
double one_plane(const std::vector<double>& ascending) {
  std::vector<double> gaps = gaps_of(ascending);
  std::sort(gaps.begin(), gaps.end());
  const double half = 0.5 * std::accumulate(gaps.begin(), gaps.end(), 0.0);
  double sum = 0;
  for (const double gap : gaps) {
    sum += gap;
    if (sum >= half) return std::min(kOnePlane_mm, kOnePlaneShare * gap);
  }
  return kOnePlane_mm;
}

/// Something unusual that was met at some places of a structure.
struct Remark {
  std::vector<std::string> places;
  void at(std::string place) {
    if (places.empty() || places.back() != place) places.push_back(std::move(place));
  }
};

/// The places of a remark, at most kNamedPlaces of them.
std::string named(const Remark& remark) {
  std::string text;
  for (std::size_t k = 0; k < std::min(kNamedPlaces, remark.places.size()); ++k)
    text += (k == 0 ? "" : ", ") + remark.places[k];
  if (remark.places.size() > kNamedPlaces) text += fmt::format(" and {} more", remark.places.size() - kNamedPlaces);
  return text;
}

/// Collects what a note says about one structure.
class Notes {
 public:
  void add(const std::string& what, const Remark& remark) {
    if (!remark.places.empty()) text_ += fmt::format("{}{} (at {})", text_.empty() ? "" : "; ", what, named(remark));
  }
  [[nodiscard]] std::optional<std::string> sentence(const std::string& name) const {
    if (text_.empty()) return std::nullopt;
    return fmt::format("Structure '{}': {}. Places in mm.", name, text_);
  }

 private:
  std::string text_;
};

/// Builds the slices of one structure.
class SliceBuilder {
 public:
  SliceBuilder(const Roi& roi, const std::string& where)
      : roi_(roi),
        where_(where.empty() ? fmt::format("structure '{}'", roi.name) : fmt::format("{}, ROI '{}'", where, roi.name)) {
  }

  Result<StructureSlices> build(const SliceFrame* given) {
    if (Result<> r = find_sound_contours(); !r) return r.error();
    if (given != nullptr) {
      out_.frame = *given;
    } else {
      out_.frame = own_frame();
    }
    if (Result<> r = flatten(); !r) return r.error();
    if (Result<> r = sort_into_planes(); !r) return r.error();
    set_ends();
    say();
    return std::move(out_);
  }

 private:
  /// A contour in its plane.
  struct Flat {
    double height;  ///< [mm] middle of its points' heights, exact where they are all the same
    double mean;    ///< [mm] their mean
    std::vector<Polygon> polygons;
  };

  [[nodiscard]] std::string place(std::size_t contour) const {
    return fmt::format("{}, contour {} (slice z = {:.2f} mm)", where_, contour + 1,
                       roi_.contours[contour].points.front().z());
  }

  /// A height in words: z for axial slices, a point of the slice's normal for others.
  [[nodiscard]] std::string slice_at(double height) const {
    const Vec3 normal = out_.frame.axes.col(2);
    const Vec3 at = out_.frame.origin + height * normal;
    if (std::abs(normal.z()) > 0.999) return fmt::format("z = {:.2f}", at.z());
    return fmt::format("slice through ({:.1f}, {:.1f}, {:.1f})", at.x(), at.y(), at.z());
  }

  Result<> find_sound_contours() {
    if (roi_.contours.empty())
      return input_error(where_, "the structure is empty", "Contour it, or choose another structure");
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < roi_.contours.size(); ++i) {
      const Contour& contour = roi_.contours[i];
      for (std::size_t k = 0; k < contour.points.size(); ++k) {
        const Vec3& p = contour.points[k];
        if (!p.allFinite()) {
          return input_error(fmt::format("{}, contour {}, point {}", where_, i + 1, k + 1),
                             fmt::format("the coordinates ({}, {}, {}) are not finite", p.x(), p.y(), p.z()),
                             "Redraw this contour");
        }
        box.extend(p);
      }
      const auto kind = detail::kind_of(contour);
      if (kind == detail::ContourKind::sound) {
        sound_.push_back(i);
      } else if (contour.points.empty()) {
        empty_.at(fmt::format("contour {}", i + 1));
      } else {
        const std::string what =
            kind == detail::ContourKind::on_a_line
                ? "points on a line"
                : fmt::format("{} point{}", contour.points.size(), contour.points.size() == 1 ? "" : "s");
        empty_.at(fmt::format("contour {}, z = {:.2f}: {}", i + 1, contour.points.front().z(), what));
      }
    }
    if (sound_.empty()) {
      return input_error(
          where_, fmt::format("none of its {} contours encloses an area: {}", roi_.contours.size(), named(empty_)),
          "Contour it with at least 3 points on every slice, or choose another structure");
    }
    const double extent = box.sizes().maxCoeff();
    if (extent >= kSmallest_mm && extent <= kLargest_mm) return Ok{};
    return input_error(where_, fmt::format("the structure is {:.4g} mm long, 1 mm to 2 m is expected", extent),
                       extent < kSmallest_mm ? "Convert the coordinates to mm; they are probably in metres"
                                             : "Convert the coordinates to mm; they are probably in micrometres");
  }

  [[nodiscard]] const Contour& largest() const {
    return roi_.contours[*std::max_element(sound_.begin(), sound_.end(), [&](std::size_t a, std::size_t b) {
      return detail::area_vector(roi_.contours[a]).norm() < detail::area_vector(roi_.contours[b]).norm();
    })];
  }

  [[nodiscard]] SliceFrame own_frame() const {
    const Contour& contour = largest();
    SliceFrame frame;
    const Vec3 normal = detail::fitted_normal(contour);
    for (const Vec3& x : contour.points) frame.origin += x / static_cast<double>(contour.points.size());
    // The sense of the normal is that of the contour, so that it turns with the structure.
    const Vec3 area = detail::area_vector(contour);
    frame.axes.col(2) = area.dot(normal) < 0 ? Vec3(-normal) : normal;
    Vec3 start = contour.points.front() - frame.origin;
    start -= start.dot(normal) * normal;
    frame.axes.col(0) = start.norm() > 1e-9 ? Vec3(start.normalized()) : frame.axes.col(2).unitOrthogonal();
    frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
    return frame;
  }

  /// Puts every contour into its plane, and resolves its small loops.
  Result<> flatten() {
    const Vec3 normal = detail::fitted_normal(largest());
    for (const std::size_t i : sound_) {
      const Contour& contour = roi_.contours[i];
      if (Result<> r = detail::check_plane(contour, normal, place(i)); !r) return r.error();
      Flat flat{0, 0, {{}}};
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const Vec3& x : contour.points) {
        const Vec3 local = out_.frame.local(x);
        flat.polygons.front().emplace_back(local.x(), local.y());
        flat.mean += local.z() / static_cast<double>(contour.points.size());
        low = std::min(low, local.z());
        high = std::max(high, local.z());
      }
      flat.height = 0.5 * (low + high);
      if (const auto crossing = detail::find_self_crossing(flat.polygons.front(), kCrossing_mm)) {
        detail::EvenOdd whole = detail::even_odd(flat.polygons.front());
        const Vec3 at = out_.frame.lps(Vec3(crossing->point.x(), crossing->point.y(), flat.height));
        const std::string where_it_crosses = fmt::format("({:.2f}, {:.2f}, {:.2f})", at.x(), at.y(), at.z());
        if (whole.loops_mm2 > std::max(kLoop_mm2, kLoopShare * whole.area_mm2) || whole.polygons.empty()) {
          return input_error(place(i),
                             fmt::format("it crosses itself at {} mm, after its points {} and {}", where_it_crosses,
                                         crossing->first_edge + 1, crossing->second_edge + 1),
                             "Redraw this contour without the loop");
        }
        loops_.at(fmt::format("contour {}, {}", i + 1, where_it_crosses));
        flat.polygons = std::move(whole.polygons);
      }
      flat_.push_back(std::move(flat));
    }
    return Ok{};
  }

  Result<> sort_into_planes() {
    std::stable_sort(flat_.begin(), flat_.end(), [](const Flat& a, const Flat& b) { return a.height < b.height; });
    std::vector<double> heights;
    for (const Flat& flat : flat_) heights.push_back(flat.height);
    const double tolerance = one_plane(heights);
    for (std::size_t first = 0, end = 0; first < flat_.size(); first = end) {
      StructureSlice slice;
      double mean = 0;
      std::vector<Polygon> contours;
      for (; end < flat_.size() && flat_[end].height - flat_[first].height < std::max(tolerance, 1e-9); ++end) {
        slice.height += flat_[end].height;
        mean += flat_[end].mean;
        std::move(flat_[end].polygons.begin(), flat_[end].polygons.end(), std::back_inserter(contours));
      }
      slice.height /= static_cast<double>(end - first);
      means_.push_back(mean / static_cast<double>(end - first));
      detail::PlaneSection section = detail::plane_section(contours);
      const std::string at = slice_at(slice.height);
      if (flat_[end - 1].height - flat_[first].height > 1e-3) heights_.at(at);
      if (section.twice > 0) twice_.at(at);
      if (section.united > 0) united_.at(at);
      if (section.holes > 0) holes_.at(at);
      if (section.parts > 1) parts_.at(at);
      slice.polygons = std::move(section.polygons);
      slice.area_mm2 = section.area_mm2;
      out_.slices.push_back(std::move(slice));
    }
    if (out_.slices.size() >= 2) return Ok{};
    return input_error(where_,
                       fmt::format("the structure has contours on one slice only ({} mm), at least 2 are needed",
                                   slice_at(out_.slices.front().height)),
                       "Contour it on every slice it reaches, or choose another structure");
  }

  /// Decides which gaps are bridged, and puts the ends of all slabs.
  void set_ends() {
    std::vector<StructureSlice>& slices = out_.slices;
    std::vector<double> gaps;
    for (std::size_t k = 1; k < means_.size(); ++k) gaps.push_back(means_[k] - means_[k - 1]);
    out_.usual_gap_mm = median(gaps);
    const double usual = out_.usual_gap_mm;
    slices.front().below = slices.back().above = 0.5 * usual;
    for (std::size_t k = 0; k + 1 < slices.size(); ++k) {
      StructureSlice& low = slices[k];
      StructureSlice& high = slices[k + 1];
      low.joins_next = gaps[k] <= kUsualGap * usual;
      if (!low.joins_next) {
        const std::string between = fmt::format("{} to {}", slice_at(low.height), slice_at(high.height));
        low.joins_next =
            gaps[k] <= std::max(kBridgedGaps * usual, kBridged_mm) &&
            detail::common_area(low.polygons, high.polygons) >= kBridgedOverlap * std::min(low.area_mm2, high.area_mm2);
        (low.joins_next ? bridged_ : apart_).at(between);
      }
      low.above = high.below = low.joins_next ? 0.5 * gaps[k] : 0.5 * usual;
    }
  }

  void say() {
    Notes notes;
    notes.add("contours that enclose nothing are left out", empty_);
    notes.add("a contour crosses itself by a small loop, which counts by the even-odd rule", loops_);
    notes.add("contours of slightly different heights are taken as one slice", heights_);
    notes.add("a contour occurs twice and counts once", twice_);
    notes.add("contours overlap in part and are united", united_);
    notes.add("a contour within another one is a hole", holes_);
    notes.add("the slice has several separate parts", parts_);
    const double usual = out_.usual_gap_mm;
    notes.add(fmt::format("slices are missing or unevenly spaced (usually {:.2f} mm), and the gap is bridged", usual),
              bridged_);
    notes.add("there is nothing in a gap that is too wide to bridge, so that the structure ends on both sides of it",
              apart_);
    out_.note = notes.sentence(roi_.name);
  }

  const Roi& roi_;
  std::string where_;
  std::vector<std::size_t> sound_;  // numbers of the contours that enclose something
  std::vector<Flat> flat_;
  std::vector<double> means_;  // of the slices: the mean heights of their points, between which gaps are measured
  StructureSlices out_;
  Remark empty_, loops_, heights_, twice_, united_, holes_, parts_, bridged_, apart_;
};

Result<StructureSlices> build(const Roi& roi, const std::string& where, const SliceFrame* frame) {
  Result<StructureSlices> slices = SliceBuilder(roi, where).build(frame);
  if (slices) return slices;
  Error error = slices.error();
  error.cure += or_skip(roi.name);
  return error;
}

}  // namespace

double StructureSlices::volume_mm3() const {
  return std::accumulate(slices.begin(), slices.end(), 0.0,
                         [](double sum, const StructureSlice& slice) { return sum + slice.volume_mm3(); });
}

Result<StructureSlices> structure_slices(const Roi& roi, const std::string& where) {
  return build(roi, where, nullptr);
}

Result<StructureSlices> structure_slices(const Roi& roi, const std::string& where, const SliceFrame& frame) {
  return build(roi, where, &frame);
}

Result<SliceFrame> common_slice_frame(std::span<const Roi* const> rois, const std::string& where) {
  Vec3 normal = Vec3::Zero();
  for (const Roi* roi : rois) {
    for (const Contour& c : roi->contours) {
      const Vec3 v = detail::area_vector(c);
      if (v.allFinite()) normal += v.dot(normal) < 0 ? Vec3(-v) : v;
    }
  }
  if (!(normal.norm() > 0)) {
    return input_error(where, "the contours enclose no area", "Export the structures again");
  }
  normal.normalize();
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal[largest] < 0) normal = -normal;
  for (int k = 0; k < 3; ++k) {
    if (normal[k] > 1 - 1e-9) normal = Vec3::Unit(k);
  }
  SliceFrame frame;
  const Vec3 along = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = (along - along.dot(normal) * normal).normalized();
  frame.axes.col(0) = u;
  frame.axes.col(1) = normal.cross(u);
  frame.axes.col(2) = normal;
  for (const Roi* roi : rois) {
    for (const Contour& c : roi->contours) {
      if (detail::kind_of(c) != detail::ContourKind::sound) continue;
      double low = HUGE_VAL;
      double high = -HUGE_VAL;
      for (const Vec3& p : c.points) {
        low = std::min(low, p.dot(normal));
        high = std::max(high, p.dot(normal));
      }
      if (high - low > kLeavesPlane_mm) {
        return input_error(fmt::format("{}, ROI '{}', contour near ({:.1f}, {:.1f}, {:.1f}) mm", where, roi->name,
                                       c.points[0].x(), c.points[0].y(), c.points[0].z()),
                           fmt::format("the contour leaves the common slice plane by {:.2f} mm, expected at most {} mm "
                                       "(parallel planar contours)",
                                       high - low, kLeavesPlane_mm),
                           "Draw all structures on the same parallel slices" + or_skip(roi->name));
      }
    }
  }
  return frame;
}

}  // namespace stylet
