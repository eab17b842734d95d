// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/rtplan_channel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::detail {

namespace {

constexpr double kSamePlace_mm = 0.01;
constexpr double kLeastMark_mm = 0.5;  // a mark of direction lies about 1 mm from its seed
constexpr double kMostMark_mm = 1.5;

bool same_place(const Vec3& a, const Vec3& b) { return (a - b).norm() < kSamePlace_mm; }

RestingPlace& place_at(std::vector<RestingPlace>& places, const ControlPoint& point) {
  auto found = std::find_if(places.begin(), places.end(),
                            [&](const RestingPlace& place) { return same_place(place.at_mm, point.at_mm); });
  if (found == places.end()) found = places.insert(places.end(), {point.at_mm, {}, 0.0});
  if (!found->axis) found->axis = point.axis;
  return *found;
}

bool is_mark(const RestingPlace& place, const RestingPlace& seed) {
  const double distance = (place.at_mm - seed.at_mm).norm();
  return distance > kLeastMark_mm && distance < kMostMark_mm;
}

/// Takes marks of direction away from places without weight, and gives their direction to the seed beside them.
void use_marks(std::vector<RestingPlace>& places) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].weight > 0.0) continue;
    const auto seed = std::find_if(places.begin(), places.end(), [&](const RestingPlace& other) {
      return other.weight > 0.0 && is_mark(places[k], other);
    });
    if (seed != places.end() && !seed->axis) seed->axis = (places[k].at_mm - seed->at_mm).normalized();
  }
}

/// Weights for a channel that has none: a seed at the first place, and at each place that is not a mark of it.
void give_weights(std::vector<RestingPlace>& places) {
  for (RestingPlace& place : places) {
    const bool mark = std::any_of(places.begin(), places.end(),
                                  [&](const RestingPlace& seed) { return seed.weight > 0.0 && is_mark(place, seed); });
    if (!mark) place.weight = 1.0;
  }
}

}  // namespace

Result<std::vector<RestingPlace>> resting_places(const std::vector<ControlPoint>& points, bool seeds,
                                                 const std::string& where) {
  std::vector<RestingPlace> places;
  const ControlPoint* before = nullptr;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ControlPoint& point = points[k];
    const double gain = before == nullptr ? point.weight : point.weight - before->weight;
    const bool gains = gain > 0.0;
    if (!point.has_place) {
      if (!gains) continue;
      return input_error(fmt::format("{}, control point {}", where, k + 1),
                         "the source stays there, and the file does not say where it is (300A,02D4)",
                         "Export the plan again with the positions of its sources");
    }
    const bool moved = before != nullptr && !same_place(before->at_mm, point.at_mm);
    const bool starts_again = moved && point.weight == 0.0;
    if (gain < -1e-9 && !starts_again && !(seeds && moved)) {
      return input_error(fmt::format("{}, control point {}", where, k + 1),
                         fmt::format("its cumulative time weight {:g} is less than the one before, {:g}", point.weight,
                                     before->weight),
                         "The file is damaged; export the plan again");
    }
    RestingPlace& place = place_at(places, point);
    if (gains && moved && !seeds) {
      place.weight += 0.5 * gain;
      place_at(places, *before).weight += 0.5 * gain;
    } else if (gains) {
      place.weight += gain;
    }
    before = &point;
  }
  if (seeds) {
    const bool weightless =
        std::none_of(places.begin(), places.end(), [](const RestingPlace& place) { return place.weight > 0.0; });
    if (weightless) give_weights(places);
    use_marks(places);
  }
  std::erase_if(places, [](const RestingPlace& place) { return place.weight <= 0.0; });
  return places;
}

}  // namespace stylet::detail
