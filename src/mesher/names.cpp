// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include "organ_names.hpp"
#include "stylet/geom/structure_names.hpp"
#include "words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace stylet {

namespace meshing {

std::vector<std::string> words_of(std::string_view name) {
  const std::string text = folded(name);
  std::vector<std::string> words;
  bool apart = true;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto c = static_cast<unsigned char>(text[n]);
    if (std::isalnum(c) == 0 && c < 0x80) {
      apart = true;
      continue;
    }
    const bool hump = n > 0 && std::isupper(c) != 0 && std::islower(static_cast<unsigned char>(text[n - 1])) != 0;
    if (apart || hump) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(c));
    apart = false;
  }
  return words;
}

}  // namespace meshing

namespace {

/// A planning volume: "PTV", "PTV1", "PTV_7800", "CTV 78 Gy", "CTVprostate", "Target", "Target volume 1".
std::string planning_volume(const std::string& p) {
  struct Word {
    std::string_view start, canonical;
  };
  constexpr std::array<Word, 6> words{{{"ctv", "ctv"},
                                       {"targetvolume", "target"},
                                       {"target", "target"},
                                       {"zielvolumen", "target"},
                                       {"ptv", "ptv"},
                                       {"gtv", "gtv"}}};
  const auto word = std::find_if(words.begin(), words.end(), [&](const Word& w) { return p.starts_with(w.start); });
  if (word == words.end()) return {};
  std::string rest = p.substr(word->start.size());
  if (rest.starts_with("prostate")) rest.erase(0, 8);
  if (rest.ends_with("gy")) rest.erase(rest.size() - 2);
  const bool number = std::all_of(rest.begin(), rest.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return number ? std::string(word->canonical) : std::string{};
}

}  // namespace

std::string canonical_region(std::string_view name) {
  const std::string p = meshing::plain(name);
  if (const auto organ = meshing::organ_named(p); !organ.empty()) return std::string(organ);
  if (const auto zone = meshing::zone_named(name); !zone.empty()) return std::string(zone);
  if (std::string femur = meshing::femur_named(name); !femur.empty()) return femur;
  return planning_volume(p);
}

bool is_target_region(std::string_view c) {
  return c == "prostate" || c == "peripheral_zone" || c == "transition_zone" || c == "central_zone" ||
         c == "anterior_stroma" || c == "ctv" || c == "target" || c == "ptv" || c == "gtv";
}

std::string region_meant(std::string_view name) {
  const std::string canonical = canonical_region(name);
  if (canonical == "target") return "prostate";
  return canonical.empty() ? std::string(name) : canonical;
}

}  // namespace stylet
