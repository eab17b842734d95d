// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

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
  std::vector<std::string> words;
  bool apart = true;
  for (std::size_t n = 0; n < name.size(); ++n) {
    const auto c = static_cast<unsigned char>(name[n]);
    if (std::isalnum(c) == 0 && c < 0x80) {
      apart = true;
      continue;
    }
    const bool hump = n > 0 && std::isupper(c) != 0 && std::islower(static_cast<unsigned char>(name[n - 1])) != 0;
    if (apart || hump) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(c));
    apart = false;
  }
  return words;
}

}  // namespace meshing

namespace {

/// Letters and digits of a name in lower case: "Femoral Head_Lt" → "femoralheadlt". Umlauts and accents are kept.
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 || u >= 0x80) out += static_cast<char>(std::tolower(u));
  }
  return out;
}

struct Synonym {
  std::string_view plain;
  std::string_view canonical;
};

// Synonyms are whole names: "optBladder", "Prostate+5mm" or "Rectum_in_PTV" are planning helpers, not anatomy. The
// names are those of AAPM TG-263 (Mayo et al. 2018), of common planning systems, and German, French, Italian and
// Spanish ones.
constexpr std::array kSynonyms{Synonym{"prostate", "prostate"},
                               Synonym{"pros", "prostate"},
                               Synonym{"prost", "prostate"},
                               Synonym{"prostata", "prostate"},
                               Synonym{"próstata", "prostate"},
                               Synonym{"prostategland", "prostate"},
                               Synonym{"glandprostate", "prostate"},
                               Synonym{"gland", "prostate"},
                               Synonym{"wholegland", "prostate"},
                               Synonym{"prostatewhole", "prostate"},
                               Synonym{"wholeprostate", "prostate"},
                               Synonym{"wg", "prostate"},
                               Synonym{"prostatecapsule", "prostate"},
                               Synonym{"prostatemr", "prostate"},
                               Synonym{"prostatemri", "prostate"},
                               Synonym{"prostatect", "prostate"},
                               Synonym{"prostateus", "prostate"},
                               Synonym{"prostatetrus", "prostate"},
                               Synonym{"centralgland", "transition_zone"},
                               Synonym{"cg", "transition_zone"},
                               Synonym{"urethra", "urethra"},
                               Synonym{"urethraprostatic", "urethra"},
                               Synonym{"prostaticurethra", "urethra"},
                               Synonym{"urethraprostate", "urethra"},
                               Synonym{"distalprostaticurethra", "urethra"},
                               Synonym{"dpu", "urethra"},
                               Synonym{"uretra", "urethra"},
                               Synonym{"urethre", "urethra"},
                               Synonym{"urètre", "urethra"},
                               Synonym{"harnröhre", "urethra"},
                               Synonym{"harnroehre", "urethra"},
                               Synonym{"bladder", "bladder"},
                               Synonym{"urinarybladder", "bladder"},
                               Synonym{"bladderwall", "bladder"},
                               Synonym{"wallbladder", "bladder"},
                               Synonym{"blase", "bladder"},
                               Synonym{"harnblase", "bladder"},
                               Synonym{"vessie", "bladder"},
                               Synonym{"vescica", "bladder"},
                               Synonym{"vejiga", "bladder"},
                               Synonym{"blad", "bladder"},
                               Synonym{"rectum", "rectum"},
                               Synonym{"rectalwall", "rectum"},
                               Synonym{"rectumwall", "rectum"},
                               Synonym{"wallrectum", "rectum"},
                               Synonym{"rektum", "rectum"},
                               Synonym{"recto", "rectum"},
                               Synonym{"retto", "rectum"},
                               Synonym{"enddarm", "rectum"},
                               Synonym{"anorectum", "rectum"},
                               Synonym{"rect", "rectum"},
                               Synonym{"pubicarch", "pubic_arch"},
                               Synonym{"pubis", "pubic_arch"},
                               Synonym{"pubicbone", "pubic_arch"},
                               Synonym{"pubicbones", "pubic_arch"},
                               Synonym{"bonepubic", "pubic_arch"},
                               Synonym{"bonepelvicpubis", "pubic_arch"},
                               Synonym{"symphysis", "pubic_arch"},
                               Synonym{"pubicsymphysis", "pubic_arch"},
                               Synonym{"symphysispubis", "pubic_arch"},
                               Synonym{"symphysispubica", "pubic_arch"},
                               Synonym{"pubicsymphys", "pubic_arch"},
                               Synonym{"arch", "pubic_arch"},
                               Synonym{"pubicsymphysisbone", "pubic_arch"},
                               Synonym{"symphyse", "pubic_arch"},
                               Synonym{"schambein", "pubic_arch"},
                               Synonym{"band", "band"},
                               Synonym{"stiffband", "band"},
                               Synonym{"puboprostaticligament", "band"},
                               Synonym{"puboprostaticligaments", "band"},
                               Synonym{"body", "body"},
                               Synonym{"external", "body"},
                               Synonym{"skin", "body"},
                               Synonym{"patient", "body"},
                               Synonym{"outline", "body"},
                               Synonym{"patientoutline", "body"},
                               Synonym{"outercontour", "body"},
                               Synonym{"bodycontour", "body"},
                               Synonym{"externalcontour", "body"},
                               Synonym{"haut", "body"},
                               Synonym{"körper", "body"},
                               Synonym{"koerper", "body"},
                               Synonym{"aussenkontur", "body"},
                               Synonym{"außenkontur", "body"},
                               Synonym{"corps", "body"},
                               Synonym{"corpo", "body"},
                               Synonym{"cuerpo", "body"},
                               Synonym{"piel", "body"},
                               Synonym{"contourexterne", "body"},
                               Synonym{"perinealskin", "body"},
                               Synonym{"surroundings", "body"},
                               Synonym{"periprostaticfat", "periprostatic_fat"},
                               Synonym{"periprostaticadiposetissue", "periprostatic_fat"},
                               Synonym{"fatperiprostatic", "periprostatic_fat"},
                               Synonym{"levator", "levator"},
                               Synonym{"levatorani", "levator"},
                               Synonym{"levatoranimuscle", "levator"},
                               Synonym{"musclelevatorani", "levator"},
                               Synonym{"muscleslevatorani", "levator"},
                               Synonym{"mlevatorani", "levator"},
                               Synonym{"ischiorectalfat", "ischiorectal_fat"},
                               Synonym{"ischiorectalfossa", "ischiorectal_fat"},
                               Synonym{"ischioanalfat", "ischiorectal_fat"},
                               Synonym{"ischioanalfossa", "ischiorectal_fat"},
                               Synonym{"subcutaneousfat", "subcutaneous_fat"},
                               Synonym{"subcutaneousadiposetissue", "subcutaneous_fat"},
                               Synonym{"fatsubcutaneous", "subcutaneous_fat"},
                               Synonym{"rectallumen", "rectal_lumen"},
                               Synonym{"rectumlumen", "rectal_lumen"},
                               Synonym{"lumenrectum", "rectal_lumen"},
                               Synonym{"seminalvesicles", "seminal_vesicles"},
                               Synonym{"seminalvesicle", "seminal_vesicles"},
                               Synonym{"seminalves", "seminal_vesicles"},
                               Synonym{"semvesicles", "seminal_vesicles"},
                               Synonym{"vesiculaeseminales", "seminal_vesicles"},
                               Synonym{"samenblasen", "seminal_vesicles"},
                               Synonym{"sv", "seminal_vesicles"},
                               Synonym{"svs", "seminal_vesicles"},
                               Synonym{"semves", "seminal_vesicles"}};

/// A name of the femoral head with "l", "lt", "left" and the like before or after it.
std::string femur(const std::string& p) {
  constexpr std::array<std::string_view, 15> bones{"femur",       "femoralhead", "femoralheads",   "femhead",
                                                   "femurhead",   "headfemur",   "femheadneck",    "femurheadneck",
                                                   "femoralneck", "fh",          "femheadandneck", "hip",
                                                   "femurkopf",   "hueftkopf",   "caput"};
  struct Side {
    std::string_view word, canonical;
  };
  constexpr std::array<Side, 8> sides{{{"left", "femur_left"},
                                       {"lt", "femur_left"},
                                       {"l", "femur_left"},
                                       {"li", "femur_left"},
                                       {"right", "femur_right"},
                                       {"rt", "femur_right"},
                                       {"r", "femur_right"},
                                       {"re", "femur_right"}}};
  for (const std::string_view bone : bones) {
    for (const Side& side : sides) {
      if (p == std::string(bone) + std::string(side.word) || p == std::string(side.word) + std::string(bone)) {
        return std::string(side.canonical);
      }
    }
  }
  return {};
}

/// A zone of the gland, or one half of it, as users of 3D Slicer and the coded terms of DICOM write it: "peripheral",
/// "PZ_left", "Transition Zone", "Structure of peripheral zone of prostate", "AFS".
std::string zone(std::string_view name) {
  constexpr std::array<std::string_view, 13> beside{"left", "right", "l",        "r",         "lt",        "rt",  "of",
                                                    "the",  "zone",  "prostate", "prostatic", "structure", "lobe"};
  constexpr std::array<Synonym, 20> zones{{{"peripheral", "peripheral_zone"},
                                           {"peripheralzone", "peripheral_zone"},
                                           {"periperal", "peripheral_zone"},
                                           {"pz", "peripheral_zone"},
                                           {"transition", "transition_zone"},
                                           {"transitional", "transition_zone"},
                                           {"transitionzone", "transition_zone"},
                                           {"transitionalzone", "transition_zone"},
                                           {"tz", "transition_zone"},
                                           {"central", "central_zone"},
                                           {"centralzone", "central_zone"},
                                           {"cz", "central_zone"},
                                           {"afs", "anterior_stroma"},
                                           {"afms", "anterior_stroma"},
                                           {"anteriorstroma", "anterior_stroma"},
                                           {"fibromuscularstroma", "anterior_stroma"},
                                           {"anteriorfibromuscularstroma", "anterior_stroma"},
                                           {"anteriorfibromuscular", "anterior_stroma"},
                                           {"anteriorfibromuscularzone", "anterior_stroma"},
                                           {"periperalzone", "peripheral_zone"}}};
  std::string rest, before;
  for (const std::string& word : meshing::words_of(name)) {
    // "gland" alone is not a filler word, because the central gland is the transition zone.
    const bool filler =
        std::find(beside.begin(), beside.end(), word) != beside.end() || (word == "gland" && before == "prostate");
    if (!filler) rest += word;
    before = word;
  }
  if (rest.starts_with("prostate")) rest.erase(0, 8);  // "prostatepz" in one word
  if (rest.ends_with("prostate")) rest.erase(rest.size() - 8);
  const auto* const found = std::find_if(zones.begin(), zones.end(), [&](const Synonym& s) { return s.plain == rest; });
  return found == zones.end() ? std::string{} : std::string(found->canonical);
}

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
  const std::string p = plain(name);
  for (const Synonym& s : kSynonyms) {
    // A canonical name is a synonym of itself.
    if (p == s.plain || name == s.canonical) return std::string(s.canonical);
  }
  if (std::string z = zone(name); !z.empty()) return z;
  if (std::string f = femur(p); !f.empty()) return f;
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
