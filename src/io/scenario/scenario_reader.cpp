// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenario/scenario_reader.hpp"

#include "detail/file_kind.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/dose/goals.hpp"
#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

namespace stylet {

namespace fs = std::filesystem;

namespace detail {

namespace {

constexpr std::uintmax_t kLargest_bytes = 1 << 20;
constexpr const char* kHowTo =
    "Name a scenario, for example scenarios/demo.toml; stylet insert --print-schema prints one to fill in";

bool is_key(const std::string& pattern) {
  const auto& keys = scenario_keys();
  return std::any_of(keys.begin(), keys.end(), [&](const ScenarioKey& key) { return key.path == pattern; });
}

/// The path of a key with the names of regions and structures and the numbers of entries replaced by the wildcards of
/// the table of keys. A name below [tissue] is a region unless it is a key of [tissue] itself.
std::string pattern_of(std::vector<std::string> path) {
  if (path.size() > 1 && path[0] == "tissue" && !is_key("tissue." + path[1])) path[1] = "<region>";
  if (path.size() > 2 && path[0] == "patient" && path[1] == "regions") path[2] = "<name>";
  for (std::string& part : path) {
    if (part.size() > 2 && part.front() == '[' && part.find_first_not_of("0123456789", 1) == part.size() - 1)
      part = "[]";
  }
  std::string text;
  for (const std::string& part : path) text += (text.empty() || part == "[]" ? "" : ".") + part;
  return text;
}

/// The tables of a scenario in the order of the documentation: "patient", "patient.regions", "tissue",
/// "tissue.<region>", "insertion[]", …
const std::vector<std::string>& known_tables() {
  static const std::vector<std::string> tables = [] {
    std::vector<std::string> all;
    for (const ScenarioKey& key : scenario_keys()) {
      const auto dot = key.path.rfind('.');
      if (dot == std::string::npos) continue;
      const std::string table = key.path.substr(0, dot);
      if (std::find(all.begin(), all.end(), table) != all.end()) continue;
      all.push_back(table);
    }
    return all;
  }();
  return tables;
}

bool is_table(const std::string& pattern) {
  return std::find(known_tables().begin(), known_tables().end(), pattern) != known_tables().end();
}

/// The header of a table in a file: "[mesh]", "[tissue.REGION]", "[[insertion]]".
std::string header_of(std::string pattern) {
  if (pattern == "tissue") pattern = "tissue.<region>";
  if (const auto at = pattern.find("<region>"); at != std::string::npos) pattern.replace(at, 8, "REGION");
  if (pattern.ends_with("[]")) return "[[" + pattern.substr(0, pattern.size() - 2) + "]]";
  return "[" + pattern + "]";
}

std::string keys_of(const std::string& table) {
  std::vector<std::string> keys;
  for (const ScenarioKey& key : scenario_keys()) {
    const auto dot = key.path.rfind('.');
    if (dot != std::string::npos && key.path.substr(0, dot) == table) keys.push_back(key.path.substr(dot + 1));
  }
  return fmt::format("{}", fmt::join(keys, ", "));
}

/// Checks that the scenario has a table. @param pattern of the table @param name of the table as the user wrote it
Result<> check_table(const std::string& pattern, const std::string& name, const std::string& where) {
  if (is_table(pattern)) return Ok{};
  if (is_table(pattern + "[]")) {
    return input_error(
        where, fmt::format("[{}] is a single table, a list of tables is expected", name),
        fmt::format("Write {} with two brackets on either side, once for each", header_of(pattern + "[]")));
  }
  if (pattern.ends_with("[]") && is_table(pattern.substr(0, pattern.size() - 2))) {
    const std::string header = header_of(pattern.substr(0, pattern.size() - 2));
    return input_error(
        where,
        fmt::format("[[{}]] is a list of tables, a single one is expected", pattern.substr(0, pattern.size() - 2)),
        fmt::format("Write {} with one bracket on either side", header));
  }
  const auto& keys = scenario_keys();
  const auto key = std::find_if(keys.begin(), keys.end(), [&](const ScenarioKey& k) { return k.path == pattern; });
  if (key != keys.end()) {
    const auto dot = name.rfind('.');
    return input_error(
        where, fmt::format("{} is a table, a value is expected", name),
        dot == std::string::npos
            ? fmt::format("Write {} = {} before the first table", name, key->example)
            : fmt::format("Write {} = {} below [{}]", name.substr(dot + 1), key->example, name.substr(0, dot)));
  }
  std::vector<std::string> headers;
  std::vector<std::string> names;
  for (const std::string& table : known_tables()) {
    if (std::find(headers.begin(), headers.end(), header_of(table)) != headers.end()) continue;
    headers.push_back(header_of(table));
    names.push_back(table.ends_with("[]") ? table.substr(0, table.size() - 2) : table);
  }
  const std::string near = nearest_name(pattern, names);
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), near) - names.begin());
  return input_error(where, fmt::format("unknown table {}", name),
                     near.empty() ? fmt::format("The tables are {}", fmt::join(headers, ", "))
                                  : fmt::format("Did you mean {}?", headers[at]));
}

Result<std::string> text_of(const fs::path& path) {
  const std::string where = path.string();
  const Result<FileKind> kind = identify(path);
  if (!kind) return input_error(where, kind.error().what, kHowTo);
  if (*kind != FileKind::unknown) {
    return input_error(
        where, fmt::format("this is {}, a scenario (TOML) is expected", name_of(*kind)),
        fmt::format("Write a scenario with source = \"{}\" below [patient]; stylet insert --print-schema "
                    "prints one to fill in",
                    path.filename().string()));
  }
  std::error_code code;
  if (const auto size = fs::file_size(path, code); size > kLargest_bytes) {
    return input_error(where, fmt::format("{} bytes are too many for a scenario (at most {})", size, kLargest_bytes),
                       kHowTo);
  }
  std::ifstream stream(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream.good() && !stream.eof()) return input_error(where, "the file cannot be read", "Check its permissions");
  if (text.find('\0') != std::string::npos)
    return input_error(where, "this is a binary file, a scenario is text (TOML)", kHowTo);
  return text;
}

}  // namespace

ScenarioReader::ScenarioReader(const fs::path& file) : file_(file) {}

Result<> ScenarioReader::read_file() {
  const Result<std::string> text = text_of(file_);
  return text ? read_text(*text) : Result<>(text.error());
}

Result<> ScenarioReader::read_text(const std::string& text) {
  const auto items = parse_toml(text, file_.string());
  if (!items) return items.error();
  for (const TomlItem& item : *items) {
    if (Result<> taken = take(item, fmt::format("{}, line {}", file_.string(), item.line)); !taken) return taken;
  }
  resolve_paths(false);
  return Ok{};
}

Result<> ScenarioReader::take(const TomlItem& item, const std::string& where) {
  const std::string path = joined(item.path);
  const std::string pattern = pattern_of(item.path);
  if (item.kind == TomlItem::Kind::table) {
    if (Result<> known = check_table(pattern, path, where); !known) return known;
    // An empty [[insertion]] counts as an insertion, and so do the other tables that form lists.
    const auto begin = [&](const char* list, auto& entries) {
      if (pattern == list && item.path.back() == fmt::format("[{}]", entries.size())) entries.emplace_back();
    };
    begin("insertion[]", scenario_.insertions);
    begin("plan.needle[]", scenario_.plan.needles);
    begin("plan.goal[]", scenario_.plan.goal_table);
    places_[path] = where;
    return Ok{};
  }
  if (item.kind == TomlItem::Kind::unusable) {
    return input_error(where, fmt::format("{} is {}", path, item.what),
                       "Give a number, a text, true or false, or a list of numbers or of texts");
  }
  for (const std::string& table : {pattern, pattern + "[]"}) {
    if (!is_table(table)) continue;
    const std::string header = header_of(table.ends_with("[]") ? path + "[]" : path);
    return input_error(where, fmt::format("{} = {} is a value, a table is expected", path, to_string(item.value)),
                       table == "tissue" ? "Write [tissue.REGION] and below it its keys: " + keys_of("tissue.<region>")
                                         : fmt::format("Write {} and below it its keys: {}", header, keys_of(table)));
  }
  if (Result<> done = set(item, where); !done) return done;
  places_[path] = where;
  return Ok{};
}

/// Sets a key. Since the override of a region holds all values, a later tissue.preset requires that all overrides are
/// rebuilt from the new defaults and the values given so far.
Result<> ScenarioReader::set(const TomlItem& item, const std::string& where) {
  if (Result<> done = set_scenario_key(scenario_, joined(item.path), item.value, where); !done) return done;
  if (pattern_of(item.path).starts_with("tissue.<region>")) tissue_values_.push_back(item);
  if (joined(item.path) != "tissue.preset") return Ok{};
  scenario_.tissue.clear();
  for (const TomlItem& given : tissue_values_) {
    if (Result<> done = set_scenario_key(scenario_, joined(given.path), given.value, where); !done) return done;
  }
  return Ok{};
}

void ScenarioReader::resolve_paths(bool current_folder_first) {
  std::error_code code;
  const fs::path file = fs::absolute(file_, code);
  const auto resolve = [&](std::string& text) {
    if (text.empty() || fs::path(text).is_absolute()) return;
    const fs::path here = fs::absolute(text, code);
    const fs::path beside = file.parent_path() / text;
    text = (current_folder_first && fs::exists(here, code) ? here : beside).lexically_normal().string();
  };
  if (scenario_.patient.source != "phantom") resolve(scenario_.patient.source);
  for (InsertionPlan& plan : scenario_.insertions) resolve(plan.motion);
  resolve(scenario_.plan.file);
  resolve(scenario_.plan.goals);
  if (fs::path(scenario_.plan.source).extension() == ".json") resolve(scenario_.plan.source);
}

std::string ScenarioReader::place(std::string path) const {
  for (;;) {
    if (const auto found = places_.find(path); found != places_.end()) return found->second;
    const auto dot = path.rfind('.');
    if (dot == std::string::npos) return file_.string();
    path.resize(dot);
  }
}

Result<Scenario> ScenarioReader::finish() && {
  const auto checked = check_scenario(scenario_, [this](const std::string& path) { return place(path); });
  if (!checked) return checked.error();
  for (std::size_t i = 0; i < scenario_.plan.goal_table.size(); ++i) {
    const Scenario::PlanGoal& goal = scenario_.plan.goal_table[i];
    const std::string name = fmt::format("plan.goal[{}]", i);
    const Result<DoseGoal> parsed = parse_goal({goal.structure, goal.metric, goal.bound, goal.citation}, place(name));
    if (parsed) continue;
    Error error = parsed.error();
    error.what = name + ": " + error.what;
    return error;
  }
  return std::move(scenario_);
}

}  // namespace detail

Result<Scenario> read_scenario(const fs::path& path, std::span<const std::string> settings) {
  detail::ScenarioReader reader(path);
  if (Result<> read = reader.read_file(); !read) return read.error();
  for (const std::string& setting : settings) {
    if (Result<> applied = reader.apply_setting(setting); !applied) return applied.error();
  }
  return std::move(reader).finish();
}

Result<Scenario> parse_scenario(const std::string& text, const fs::path& path, std::span<const std::string> settings) {
  detail::ScenarioReader reader(path);
  if (Result<> read = reader.read_text(text); !read) return read.error();
  for (const std::string& setting : settings) {
    if (Result<> applied = reader.apply_setting(setting); !applied) return applied.error();
  }
  return std::move(reader).finish();
}

}  // namespace stylet
