// SPDX-License-Identifier: GPL-3.0-or-later
#include "structure_choice.hpp"

#include "organ_names.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/geom/structure_names.hpp"
#include "words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <set>

namespace stylet::meshing {
namespace {

/// Kinds of planning volumes, most likely the gland first. The CTV of an implant is the gland; a PTV, or a target of
/// unknown kind, may have a margin around it; a GTV may be a lesion within it.
struct Kind {
  std::string_view name, caution;
};
constexpr std::array<Kind, 4> kPlanning{{{"ctv", ""},
                                         {"target", ""},
                                         {"ptv", "; a PTV often has a margin around the gland"},
                                         {"gtv", "; a GTV is often only a lesion within the gland"}}};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::size_t planning_rank(std::string_view kind) {
  const auto found = std::find_if(kPlanning.begin(), kPlanning.end(), [&](const Kind& k) { return k.name == kind; });
  return static_cast<std::size_t>(found - kPlanning.begin());
}

/// Whether a word of the name, without trailing digits, is one of the wanted words.
bool has_word(std::string_view name, std::initializer_list<std::string_view> wanted) {
  for (std::string word : words_of(name)) {
    while (!word.empty() && std::isdigit(static_cast<unsigned char>(word.back())) != 0) word.pop_back();
    if (std::find(wanted.begin(), wanted.end(), word) != wanted.end()) return true;
  }
  return false;
}

/// Whether a part of the name is a word for the gland.
bool names_gland(std::string_view name) {
  const std::string text = plain(name);
  constexpr std::array<std::string_view, 5> words{"prost", "простат", "предстат", "前列腺", "前立腺"};
  return std::any_of(words.begin(), words.end(), [&](std::string_view w) { return text.find(w) != std::string::npos; });
}

/// How well the name of a planning volume fits the gland, whatever its kind: 0 = it names the gland; 1 = it names no
/// place; 2 and 3 = the same for a volume that also names lymph nodes or a boost, which are beside the gland or a part
/// of it.
std::size_t naming_rank(std::string_view name) {
  const std::size_t other = has_word(name, {"ln", "lns", "node", "nodes", "nodal", "boost"}) ? 2 : 0;
  return other + (names_gland(name) ? 0 : 1);
}

bool is_planning(std::string_view kind) { return planning_rank(kind) < kPlanning.size(); }

/// Region by the candidate's name, else by its coded term; empty when neither is recognised.
std::string region_named(const Candidate& candidate) {
  std::string by_name = canonical_region(candidate.name);
  return by_name.empty() ? canonical_region(candidate.meaning) : by_name;
}

/// The candidates and the decisions about them.
class Decision {
 public:
  Decision(const std::vector<Candidate>& candidates, const MeshOptions& options, std::string source, std::string kind,
           bool apart)
      : candidates_(candidates), options_(options), source_(std::move(source)), kind_(std::move(kind)), apart_(apart) {
    for (const Candidate& c : candidates_) {
      names_.push_back(c.name);
      words_.push_back(c.word);
      uses_.push_back({.name = c.name, .number = c.number, .region = "", .why = c.nothing});
      open_.push_back(c.nothing.empty());
    }
  }

  Result<std::vector<StructureUse>> made() {
    if (auto done = skip_those_named(); !done) return done.error();
    if (auto done = take_those_named(); !done) return done.error();
    take_by_name();
    find_gland();
    find_body();
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      if (open_[i]) leave(i, kNotRecognised);
    }
    return uses_;
  }

 private:
  /// Positions of the candidates to which a user's word refers.
  [[nodiscard]] Result<std::vector<std::size_t>> meant(const std::string& word, const std::string& key) const {
    std::vector<std::size_t> found = find_named(names_, word);
    if (found.empty()) found = find_named(words_, word);
    if (!found.empty()) return found;
    std::vector<std::string> known;
    for (const Candidate& c : candidates_)
      known.push_back(c.word.empty() || c.word == c.name ? c.name : fmt::format("{} ({})", c.name, c.word));
    const std::string near = nearest_name(word, names_);
    return input_error(source_, fmt::format("{}: there is no {} '{}'; the file has {}", key, kind_, word, known),
                       near.empty() ? "Name one of these" : fmt::format("Did you mean '{}'?", near));
  }

  void leave(std::size_t i, std::string why) {
    leave_out(uses_[i], std::move(why));
    open_[i] = false;
  }

  void take(std::size_t i, std::string region, std::string why = {}) {
    uses_[i].region = std::move(region);
    uses_[i].why = std::move(why);
    open_[i] = false;
  }

  Result<> skip_those_named() {
    for (const std::string& word : options_.skip) {
      const auto found = meant(word, "patient.skip");
      if (!found) return found.error();
      for (const std::size_t i : *found) {
        // A reader that knows `skip` leaves the structure empty; its reason then is still that the user named it.
        if (candidates_[i].nothing.empty() || candidates_[i].nothing == kEmpty) leave(i, kSkipped);
      }
    }
    return Ok{};
  }

  Result<> take_those_named() {
    for (const auto& [word, region] : options_.regions) {
      const auto found = meant(word, "patient.regions");
      if (!found) return found.error();
      bool taken = false;
      for (const std::size_t i : *found) {
        if (uses_[i].why == kSkipped) {
          return input_error(
              source_,
              fmt::format("{} '{}' is named both in patient.skip and in patient.regions, expected in one of them",
                          kind_, word),
              "Remove it from one of the two");
        }
        if (!candidates_[i].nothing.empty()) continue;
        take(i, region_meant(region), "named in [patient.regions]");
        asked_.insert(uses_[i].region);
        named_.insert(i);
        taken = true;
      }
      if (!taken) {
        const std::string& nothing = candidates_[found->front()].nothing;
        return input_error(fmt::format("{}, {} '{}'", source_, kind_, word),
                           fmt::format("it has nothing to mesh ({})", nothing),
                           "Remove it from patient.regions, or name another one");
      }
    }
    return Ok{};
  }

  void take_by_name() {
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      if (!open_[i]) continue;
      const std::string region = region_named(candidates_[i]);
      if (region.empty() || is_planning(region)) continue;
      if (!asked_.contains(region)) {
        take(i, region);
      } else if (belongs_beside_named(i, region)) {
        take(i, region, fmt::format("taken as {} together with {}", region, names_taken_as(region)));
      } else {
        leave(i, fmt::format("the region {1} is assigned to {0}", names_taken_as(region), region));
      }
    }
  }

  /// Whether a structure belongs to the same region as the structures that the user assigned to it. A label of a mask
  /// does, because its voxels belong to nothing else. Contours may be another drawing of the same organ, so they do
  /// not, unless they are a half (left or right) that the user did not assign.
  [[nodiscard]] bool belongs_beside_named(std::size_t i, const std::string& region) const {
    if (apart_) return true;
    const std::string_view side = side_of(candidates_[i].name);
    if (side.empty() || region.ends_with("_left") || region.ends_with("_right")) return false;
    return std::none_of(named_.begin(), named_.end(), [&](std::size_t n) {
      return uses_[n].region == region && side_of(candidates_[n].name) == side;
    });
  }

  [[nodiscard]] std::string names_taken_as(const std::string& region) const {
    std::vector<std::string> names;
    for (const StructureUse& use : uses_) {
      if (use.region == region) names.push_back(fmt::format("'{}'", use.name));
    }
    return fmt::format("{}", fmt::join(names, ", "));
  }

  /// "ctv", "target", "ptv" or "gtv", by name, else by type; empty for anything else.
  [[nodiscard]] std::string planning_kind(const Candidate& c) const {
    const std::string by_name = region_named(c);
    if (!by_name.empty()) return is_planning(by_name) ? by_name : std::string();
    const std::string by_type = lower(c.type);
    return by_type != "target" && is_planning(by_type) ? by_type : std::string();
  }

  [[nodiscard]] bool has(const auto& wanted) const {
    return std::any_of(uses_.begin(), uses_.end(), [&](const StructureUse& u) { return wanted(u.region); });
  }

  /// Planning volumes are not anatomy, but one is used as the gland if the gland itself is not drawn. The best
  /// naming_rank() wins, then the most likely kind. Within a kind, a volume named exactly like the kind is preferred,
  /// then one with a longer name, then one recognised by its type, then the first.
  void find_gland() {
    const bool drawn =
        has([](const std::string& r) { return r == "prostate" || r == "peripheral_zone" || r == "transition_zone"; });
    const bool asked =
        std::any_of(asked_.begin(), asked_.end(), [](const std::string& r) { return is_target_region(r); });
    std::vector<std::pair<std::array<std::size_t, 4>, std::size_t>> volumes;  // rank, candidate
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      if (!open_[i]) continue;
      const std::string kind = planning_kind(candidates_[i]);
      if (kind.empty()) continue;
      const std::size_t naming = lower(candidates_[i].name) == kind ? 0 : region_named(candidates_[i]) == kind ? 1 : 2;
      volumes.push_back({{naming_rank(candidates_[i].name), planning_rank(kind), naming, i}, i});
    }
    if (volumes.empty()) return;
    std::string why = fmt::format("{}, and the gland is drawn", kPlanningVolume);
    if (asked) why = fmt::format("{}, and another structure is named as the target", kPlanningVolume);
    if (!drawn && !asked) {
      const auto& [rank, best] = *std::min_element(volumes.begin(), volumes.end());
      take(best, "prostate",
           fmt::format("taken as the gland, since no {} is named prostate{}", kind_, kPlanning[rank[1]].caution));
      why = fmt::format("{}, and '{}' is taken as the gland", kPlanningVolume, candidates_[best].name);
    }
    for (const auto& [rank, i] : volumes) {
      if (open_[i]) leave(i, why);
    }
  }

  void find_body() {
    if (has([](const std::string& r) { return r == "body"; })) return;
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      if (!open_[i] || lower(candidates_[i].type) != "external") continue;
      take(i, "body", fmt::format("taken as the body, since no {} is named body", kind_));
      return;
    }
  }

  const std::vector<Candidate>& candidates_;
  const MeshOptions& options_;
  std::string source_, kind_;
  bool apart_ = false;  ///< candidates cannot overlap
  std::vector<std::string> names_, words_;
  std::vector<StructureUse> uses_;
  std::vector<bool> open_;       ///< not decided yet
  std::set<std::string> asked_;  ///< regions that MeshOptions::regions assigns
  std::set<std::size_t> named_;  ///< candidates to which it assigns them
};

/// Notes such as "The structures are left out (empty): 'CTV', 'PROS'.", one for each reason.
std::vector<std::string> tell_left_out(const std::vector<StructureUse>& uses, const std::string& kind) {
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
  for (const StructureUse& use : uses) {
    if (!use.region.empty()) continue;
    auto reason = std::find_if(reasons.begin(), reasons.end(), [&](const auto& r) { return r.first == use.why; });
    if (reason == reasons.end()) reason = reasons.insert(reasons.end(), {use.why, {}});
    reason->second.push_back(fmt::format("'{}'", use.name));
  }
  std::vector<std::string> told;
  for (const auto& [why, names] : reasons) {
    told.push_back(fmt::format("The {}{} left out ({}): {}.", kind, names.size() == 1 ? " is" : "s are", why,
                               fmt::join(names, ", ")));
  }
  return told;
}

}  // namespace

void leave_out(StructureUse& use, std::string why) {
  use.region.clear();
  use.why = std::move(why);
}

Result<std::vector<StructureUse>> decide(const std::vector<Candidate>& candidates, const MeshOptions& options,
                                         const std::string& source, const std::string& kind, bool apart) {
  return Decision(candidates, options, source, kind, apart).made();
}

StructureChoice told(std::vector<StructureUse> uses, const std::vector<Candidate>& candidates,
                     const std::string& kind) {
  StructureChoice choice;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (!uses[i].region.empty() && uses[i].why.starts_with("taken as")) {
      const std::string& type = candidates[i].type;
      choice.notes.push_back(fmt::format("The {} '{}'{} is {}.", kind, uses[i].name,
                                         type.empty() ? "" : fmt::format(" (type {})", type), uses[i].why));
    }
  }
  choice.left_out = tell_left_out(uses, kind);
  choice.notes.insert(choice.notes.end(), choice.left_out.begin(), choice.left_out.end());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    choice.has_target = choice.has_target || is_target_region(uses[i].region);
    (candidates[i].nothing.empty() ? choice.uses : choice.empty).push_back(std::move(uses[i]));
  }
  return choice;
}

}  // namespace stylet::meshing
