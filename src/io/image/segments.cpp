// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/segments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace stylet::detail {

namespace {

struct Sized {
  const Segment* segment = nullptr;
  std::ptrdiff_t voxels = 0;
};

std::vector<Sized> largest_first(const std::vector<Segment>& segments) {
  std::vector<Sized> sized;
  for (const Segment& s : segments) sized.push_back({&s, std::count(s.inside.begin(), s.inside.end(), true)});
  std::stable_sort(sized.begin(), sized.end(), [](const Sized& a, const Sized& b) { return a.voxels > b.voxels; });
  return sized;
}

}  // namespace

void paint(std::vector<Segment> segments, LabelImage& image) {
  std::map<int, std::string> called;
  for (const Segment& s : segments) {
    called[s.label] = s.name.empty() ? fmt::format("segment {}", s.label) : s.name;
    if (!s.name.empty()) image.names[s.label] = s.name;
    if (!s.meaning.empty()) image.meanings[s.label] = s.meaning;
  }
  std::map<std::pair<int, int>, std::size_t> overlaps;  // (smaller, larger) → voxels
  for (const auto& [segment, voxels] : largest_first(segments)) {
    if (voxels == 0) image.notes.push_back(fmt::format("segment '{}' is empty", called[segment->label]));
    for (std::size_t n = 0; n < image.labels.size(); ++n) {
      if (!segment->inside[n]) continue;
      if (image.labels[n] != 0) ++overlaps[{segment->label, image.labels[n]}];
      image.labels[n] = static_cast<std::uint16_t>(segment->label);
    }
  }
  for (const auto& [pair, voxels] : overlaps) {
    image.notes.push_back(fmt::format("'{0}' and '{1}' share {2} voxel{3}: the smaller segment, '{0}', has {4}",
                                      called[pair.first], called[pair.second], voxels, voxels == 1 ? "" : "s",
                                      voxels == 1 ? "it" : "them"));
  }
}

}  // namespace stylet::detail
