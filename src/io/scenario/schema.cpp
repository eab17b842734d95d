// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace stylet {

namespace {

constexpr std::size_t kSchemaWidth = 110;

struct TableText {
  std::string_view pattern;  ///< path of the table with wildcards
  std::string_view header;   ///< the table's header with an example instead of a wildcard
  std::string_view about;
};

constexpr std::array kTables{
    TableText{"patient", "[patient]", "The patient. Only this table and [[insertion]] must be filled in."},
    TableText{"patient.regions", "[patient.regions]",
              "Regions for structures or labels. Structures that are not listed here are recognised by their names "
              "(prostate, urethra, bladder, rectum, pubic_arch, femur_left, femur_right, band, body, seminal_vesicles "
              "and the zones of the gland, in several spellings); if no structure is the prostate, a CTV, target, PTV "
              "or GTV is used as the gland. Without this table all labels of a mask are used."},
    TableText{"tissue", "[tissue]", "Settings for all tissue. No region may have the name of one of these keys."},
    TableText{"tissue.<region>", "[tissue.prostate]",
              "Properties of a tissue, in one table for each region that differs from its defaults. The defaults of "
              "the prostate are shown. docs/parameters.md gives all defaults and their sources."},
    TableText{"fixed", "[fixed]", "Supports, which hold the patient in place. They decide every force."},
    TableText{"anatomy", "[anatomy]",
              "Soft tissue that contours and masks do not show. Each layer is added if the input does not have it."},
    TableText{"mesh", "[mesh]", "How contours or a mask become tetrahedra; a tetrahedral mesh is used as it is."},
    TableText{"needle", "[needle]", "The needle."},
    TableText{"coupling", "[coupling]", "The interaction of needle and tissue."},
    TableText{"template", "[template]", "The guide template: a grid of holes in front of the perineum."},
    TableText{
        "insertion[]", "[[insertion]]",
        "One needle going in and out: through a template hole, through a point in a direction or towards a target, or "
        "along a recorded motion. Repeat the table for further needles, which follow one after the other."},
    TableText{"plan", "[plan]",
              "A plan of permanent seeds, for stylet implant: a file, or needles in the scenario ([[plan.needle]]). A "
              "scenario with a plan needs no [[insertion]]."},
    TableText{"plan.needle[]", "#[[plan.needle]]",
              "A needle of the plan with its permanent seeds, instead of plan.file. It is along z, as a template holds "
              "it. Repeat the table for further needles."},
    TableText{"plan.goal[]", "#[[plan.goal]]", "A goal for the dose, instead of a file with plan.goals."},
    TableText{"procedure", "[procedure]", "How the needles of the plan go in and out."},
    TableText{"seed", "[seed]", "The fate of a seed, beside the motion of the tissue."},
    TableText{"oedema", "[oedema]", "Swelling of the gland after the implantation, for the dose."},
    TableText{"probe", "[probe]", "The ultrasound probe in the rectum: what it is and where its stepper holds it."},
    TableText{"ultrasound", "[ultrasound]", "The ultrasound scanner, for pictures."},
    TableText{"fluoroscopy", "[fluoroscopy]", "The X-ray unit, for pictures."},
    TableText{"run", "[run]", "The simulation."},
    TableText{"output", "[output]", "The frames and pictures that are kept."},
};

/// Number of characters (UTF-8 code points).
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// A text as comment lines of at most kSchemaWidth columns.
std::string comment(std::string_view text) {
  std::string out;
  std::string line = "#";
  while (!text.empty()) {
    const auto blank = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, blank);
    if (width(line) + 1 + width(word) > kSchemaWidth) {
      out += line + "\n";
      line = "#";
    }
    (line += ' ') += word;
    text.remove_prefix(std::min(blank + 1, text.size()));
  }
  return out + line + "\n";
}

std::string capitalised(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// The comment on a key, such as "Young's modulus. 0.1 … 1000 kPa. Default: by region.", and the key with a value, also
/// commented out.
std::string key_text(const ScenarioKey& key, const std::string& name) {
  std::string about = capitalised(key.meaning);
  if (key.range.starts_with('"')) {
    about += (key.range.find(',') != std::string::npos ? ". One of " : ". Only ") + key.range;
  } else if (key.range != "text") {
    about += ". " + capitalised(key.range) + (key.unit.empty() ? "" : " " + key.unit);
  }
  about += ".";
  if (key.standard == "required") {
    about += " Required.";
  } else if (key.standard != key.example) {
    about += " Default: " + key.standard + ".";
  }
  return comment(about) + fmt::format("#{} = {}\n", name, key.example);
}

}  // namespace

std::string schema_text() {
  std::string out =
      comment(
          "All keys of a scenario, commented out, each with its meaning, range and unit. The value shown is the "
          "default unless another default is named. Save this text as my.toml, remove the # before source and hole, "
          "and run: stylet insert my.toml") +
      comment("Patient coordinates are DICOM LPS: x to the patient's left, y to posterior, z to superior.");
  std::string last;
  for (const ScenarioKey& key : scenario_keys()) {
    const auto dot = key.path.rfind('.');
    const std::string pattern = dot == std::string::npos ? "" : key.path.substr(0, dot);
    std::string name = key.path.substr(dot == std::string::npos ? 0 : dot + 1);
    if (name == "<name>") name = "\"1\"";
    const auto table =
        std::find_if(kTables.begin(), kTables.end(), [&](const auto& t) { return t.pattern == pattern; });
    if (pattern != last && table != kTables.end()) {
      out += "\n" + comment(table->about) + fmt::format("{}\n", table->header);
    }
    last = pattern;
    out += "\n" + key_text(key, name);
  }
  return out;
}

}  // namespace stylet
