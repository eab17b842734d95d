// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/segments.hpp"

#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace stylet::detail {

namespace {

/// For each segment whether a word of the user means it, by its name, or else by its label.
std::vector<bool> listed(const std::vector<Segment>& segments, std::span<const std::string> words) {
  std::vector<std::string> names, numbers;
  for (const Segment& s : segments) {
    names.push_back(s.name);
    numbers.push_back(std::to_string(s.label));
  }
  std::vector<bool> in(segments.size(), false);
  for (const std::string& word : words) {
    std::vector<std::size_t> found = find_named(names, word);
    if (found.empty()) found = find_named(numbers, word);
    for (const std::size_t s : found) in[s] = true;
  }
  return in;
}

/// The runs sorted by the sizes of their segments, the largest first; segments of equal size keep their order.
std::vector<Run> largest_first(std::vector<Run> runs, const std::vector<std::size_t>& voxels) {
  std::stable_sort(runs.begin(), runs.end(), [&](const Run& a, const Run& b) {
    return std::pair(voxels[b.segment], a.segment) < std::pair(voxels[a.segment], b.segment);
  });
  return runs;
}

}  // namespace

Result<> paint(const std::vector<Segment>& segments, const std::vector<Run>& runs, std::span<const std::string> skip,
               LabelImage& image) {
  const std::vector<bool> skipped = listed(segments, skip);
  if (!segments.empty() && std::find(skipped.begin(), skipped.end(), false) == skipped.end()) {
    return input_error(image.source, "every segment is left out", "Remove one of them from [patient] skip");
  }
  std::vector<std::size_t> voxels(segments.size(), 0);
  for (const Run& run : runs) voxels[run.segment] += run.count;
  std::map<int, std::string> called;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto& [label, name, meaning] = segments[s];
    called[label] = name.empty() ? fmt::format("segment {}", label) : name;
    if (!name.empty()) image.names[label] = name;
    if (!meaning.empty()) image.meanings[label] = meaning;
    if (skipped[s]) image.names.try_emplace(label, std::to_string(label));  // keeps the skipped label known
    if (voxels[s] == 0 && !skipped[s]) image.notes.push_back(fmt::format("Segment '{}' is empty.", called[label]));
  }
  std::map<std::pair<int, int>, std::size_t> overlaps;  // (smaller, larger) → voxels
  for (const Run& run : largest_first(runs, voxels)) {
    if (skipped[run.segment]) continue;
    const int label = segments[run.segment].label;
    for (std::size_t n = run.first; n < run.first + std::size_t{run.count}; ++n) {
      const int below = image.labels[n];
      if (below != 0 && below != label) ++overlaps[{label, below}];
      image.labels[n] = static_cast<std::uint16_t>(label);
    }
  }
  for (const auto& [pair, shared] : overlaps) {
    image.notes.push_back(fmt::format("'{0}' and '{1}' share {2} voxel{3}: the smaller segment, '{0}', keeps {4}.",
                                      called[pair.first], called[pair.second], shared, shared == 1 ? "" : "s",
                                      shared == 1 ? "it" : "them"));
  }
  return Ok{};
}

}  // namespace stylet::detail
