// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/body_parts.hpp"

#include "stylet/geom/structure_names.hpp"
#include "words.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace stylet {

namespace {

// Stems in lower case. Words that also name something of the male pelvis are not here: "neck" (of the bladder, of the
// femur), "cord" (spermatic cord), "bulb", "bowel".
constexpr std::array<std::string_view, 119> kOtherParts{
    "heart",       "lung",          "breast",      "chestwall",    "brain",      "brainstem",      "eye",
    "lens",        "cornea",        "retina",      "optic",        "opticnerve", "chiasm",         "cochlea",
    "parotid",     "larynx",        "pharynx",     "mandible",     "tongue",     "thyroid",        "esophagus",
    "oesophagus",  "trachea",       "bronchus",    "aorta",        "sternum",    "spinalcord",     "spinalcanal",
    "myelon",      "liver",         "kidney",      "stomach",      "spleen",     "pancreas",       "duodenum",
    "gallbladder", "humerus",       "knee",        "tibia",        "pituitary",  "hippocampus",    "carina",
    "ventricle",   "atrium",        "skull",       "clavicle",     "herz",       "lunge",          "lungen",
    "brust",       "mamma",         "gehirn",      "hirn",         "hirnstamm",  "auge",           "augen",
    "linse",       "leber",         "niere",       "nieren",       "magen",      "milz",           "rückenmark",
    "rueckenmark", "spinalkanal",   "speiseröhre", "speiseroehre", "luftröhre",  "kehlkopf",       "schilddrüse",
    "coeur",       "cœur",          "poumon",      "sein",         "cerveau",    "oeil",           "œil",
    "yeux",        "foie",          "rein",        "estomac",      "moelle",     "moelleépinière", "oesophage",
    "trachée",     "tronccérébral", "cuore",       "polmone",      "polmoni",    "mammella",       "cervello",
    "occhio",      "fegato",        "rene",        "reni",         "stomaco",    "midollo",        "esofago",
    "milza",       "corazon",       "corazón",     "pulmon",       "pulmón",     "pulmones",       "mama",
    "cerebro",     "ojo",           "higado",      "hígado",       "riñon",      "riñón",          "riñones",
    "estomago",    "estómago",      "medula",      "médula",       "lacrimal",   "vertebra",       "scapula"};

constexpr std::array<std::string_view, 27> kFemaleParts{
    "uterus",      "cervix",      "vagina",      "vaginal",      "ovary",       "ovaries", "vulva",
    "endometrium", "parametrium", "gebärmutter", "gebaermutter", "zervix",      "scheide", "eierstock",
    "eierstöcke",  "utérus",      "vagin",       "ovaire",       "utero",       "útero",   "cervice",
    "cérvix",      "ovaio",       "ovario",      "ovarios",      "uterocervix", "utcervix"};

// Parts of names: these scripts have no blanks, or bend their words. Russian words are given without a first letter,
// which may be a capital.
constexpr std::array<std::string_view, 32> kOtherParts_inside{
    "心脏",  "心臓",  "心臟",  "肺",    "乳腺",    "乳房",         "脑",          "脳",    "腦",   "眼",     "肝",
    "肾",    "腎",    "脾",    "胃",    "脊髓",    "食管",         "食道",        "气管",  "気管", "甲状腺", "ердце",
    "ёгкое", "ёгкие", "егкое", "егкие", "олочная", "оловной мозг", "пинной мозг", "ечень", "почк", "Почк"};
constexpr std::array<std::string_view, 11> kFemaleParts_inside{"子宫", "子宮",  "宫颈",  "阴道",    "膣",   "卵巢",
                                                               "卵巣", "матка", "Матка", "лагалищ", "ичник"};

constexpr std::array<std::string_view, 20> kSides{
    "l",      "r",     "lt",     "rt",       "left",   "right",     "li",      "re",        "links",   "rechts",
    "gauche", "droit", "droite", "sinistra", "destra", "izquierdo", "derecho", "izquierda", "derecha", "s"};

/// Whether a word is a stem, alone or joined to a side or to the plural's "s".
bool is_stem(std::string_view word, std::string_view stem) {
  if (word == stem) return true;
  const auto joined = [&](std::string_view side) {
    return word.size() == stem.size() + side.size() &&
           ((word.starts_with(stem) && word.ends_with(side)) ||
            (side != "s" && word.starts_with(side) && word.ends_with(stem)));
  };
  return std::any_of(kSides.begin(), kSides.end(), joined);
}

bool names_one_of(std::string_view name, const auto& stems, const auto& inside) {
  const std::vector<std::string> words = meshing::words_of(name);
  std::vector<std::string> tried = words;
  for (std::size_t k = 1; k < words.size(); ++k) tried.push_back(words[k - 1] + words[k]);  // "spinal cord"
  for (std::string& word : tried) {
    while (!word.empty() && word.back() >= '0' && word.back() <= '9') word.pop_back();
    if (std::any_of(stems.begin(), stems.end(), [&](std::string_view stem) { return is_stem(word, folded(stem)); }))
      return true;
  }
  return std::any_of(inside.begin(), inside.end(),
                     [&](std::string_view part) { return name.find(part) != std::string_view::npos; });
}

}  // namespace

BodyPart body_part(std::string_view name) {
  if (names_one_of(name, kFemaleParts, kFemaleParts_inside)) return BodyPart::female;
  return names_one_of(name, kOtherParts, kOtherParts_inside) ? BodyPart::other : BodyPart::none;
}

}  // namespace stylet
