// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenario/toml_document.hpp"

#include "detail/text.hpp"
#include "reading/ask.hpp"
#include "scenario/toml_precheck.hpp"

#include <fmt/format.h>
#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

namespace stylet::detail {

namespace {

using Type = ScenarioValue::Type;

/// Converts a TOML node to a ScenarioValue; if that is impossible, the item becomes `unusable` and `what` names its
/// type.
void convert(const toml::node& node, TomlItem& item) {
  item.kind = TomlItem::Kind::value;
  ScenarioValue& v = item.value;
  const auto unusable = [&](const char* what) {
    item.kind = TomlItem::Kind::unusable;
    item.what = what;
  };
  switch (node.type()) {
    case toml::node_type::string:
      v.type = Type::text;
      v.text = node.ref<std::string>();
      return;
    case toml::node_type::integer:
      v.type = Type::integer;
      v.number = static_cast<double>(node.ref<std::int64_t>());
      return;
    case toml::node_type::floating_point:
      v.type = Type::number;
      v.number = node.ref<double>();
      return;
    case toml::node_type::boolean:
      v.type = Type::boolean;
      v.boolean = node.ref<bool>();
      return;
    case toml::node_type::array:
      break;
    default:
      return unusable("a date or a time");
  }
  for (const toml::node& element : *node.as_array()) {
    if (element.is_string()) {
      v.texts.push_back(element.ref<std::string>());
    } else if (element.is_number()) {
      v.numbers.push_back(*element.value<double>());
    } else {
      return unusable("a list of other values than numbers or texts");
    }
  }
  if (!v.texts.empty() && !v.numbers.empty()) return unusable("a list of numbers and texts mixed");
  v.type = v.texts.empty() ? Type::numbers : Type::texts;
}

void collect(const toml::node& node, const std::vector<std::string>& path, std::vector<TomlItem>& items) {
  TomlItem item;
  item.path = path;
  item.line = node.source().begin.line;
  item.column = node.source().begin.column;
  const auto child = [&](const std::string& name, const toml::node& value) {
    std::vector<std::string> longer = path;
    longer.push_back(name);
    collect(value, longer, items);
  };
  if (const toml::table* table = node.as_table()) {
    item.kind = TomlItem::Kind::table;
    if (!path.empty()) items.push_back(std::move(item));
    for (const auto& [key, value] : *table) child(std::string(key.str()), value);
    return;
  }
  if (const toml::array* array = node.as_array(); array && !array->empty() && array->is_homogeneous<toml::table>()) {
    for (std::size_t i = 0; i < array->size(); ++i) child(fmt::format("[{}]", i), *array->get(i));
    return;
  }
  convert(node, item);
  items.push_back(std::move(item));
}

/// The cure for a line that is not valid TOML; it recognises the most common mistakes.
std::string cure_for(std::string_view line) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) {
    return "Write key = value on a line of its own, below a [table]; comments start with #";
  }
  const std::string value = trimmed(line.substr(equals + 1));
  if (value.empty()) return "Give the key a value, or put a # before the line";
  if (std::isalpha(static_cast<unsigned char>(value.front())) != 0) {
    return fmt::format("Put texts in quotes (\"{}\"); write true and false in lower case, without quotes",
                       trimmed(std::string_view(value).substr(0, value.find('#'))));
  }
  if (value.find(',') != std::string::npos && value.front() != '[' && value.front() != '"' && value.front() != '{') {
    return "Write decimals with a point (0.5) and lists in brackets ([1, 2, 3])";
  }
  if (std::count(value.begin(), value.end(), '"') % 2 != 0) return "Close the text with a second quotation mark";
  return "Write key = value, texts in quotes (\"D4\"), lists in brackets ([1, 2, 3]), each key once in its table";
}

/// The fault that the parser has found, in words for people who do not know the grammar of TOML.
/// @param what the parser's own words
std::string fault_of(std::string_view what) {
  struct Fault {
    std::string_view sign, words;
  };
  constexpr std::array<Fault, 14> kFaults{{{"end-of-file", "the file ends too early"},
                                           {"cannot redefine", "this key or table was given before"},
                                           {"cannot insert", "this key or table was given before"},
                                           {"control character", "there is a control character"},
                                           {"escape sequence", "a backslash in a text has to be written twice"},
                                           {"leading zeroes", "a number begins with a needless 0"},
                                           {"nderscores", "an underscore stands in a wrong place"},
                                           {"not representable", "a number is too large"},
                                           {"too long", "a number is too long"},
                                           {"exceed", "a text, a number or a list is too long"},
                                           {"brackets must be", "the brackets of a table must touch: [[name]]"},
                                           {"multi-line strings", "a name may not go on in the next line"},
                                           {"saw comma", "a comma is not expected here"},
                                           {"dangling comma", "a comma before the closing brace is not allowed"}}};
  const auto known = std::find_if(kFaults.begin(), kFaults.end(),
                                  [&](const Fault& fault) { return what.find(fault.sign) != std::string_view::npos; });
  if (known != kFaults.end()) return std::string(known->words);
  constexpr std::string_view kSaw = "saw '";
  const auto saw = what.rfind(kSaw);
  if (saw == std::string_view::npos) return "this is neither a number, a text in quotes, a list, true nor false";
  const std::string_view rest = what.substr(saw + kSaw.size());
  const std::string_view seen = rest.substr(0, rest.rfind('\''));
  const bool is_end = seen.empty() || seen.front() == '\n' || seen.front() == '\r' || seen.starts_with("\\n");
  return is_end ? "the line ends too early" : fmt::format("'{}' is not expected here", seen);
}

/// @param what message of the parser @param line text of the line where it stopped
Error syntax_error(const std::string& where, const std::string& what, const std::string& line) {
  if (lower(what).find("utf-8") != std::string::npos) {
    return input_error(where, "this is not text in UTF-8", "Save the file as text in UTF-8, or name another file");
  }
  // Quote the line if it is short and has readable characters only.
  const bool readable = !line.empty() && line.size() <= 100 && is_readable(line);
  return input_error(where, fmt::format("{}this is not valid TOML ({})", readable ? line + ": " : "", fault_of(what)),
                     cure_for(readable ? line : ""));
}

}  // namespace

Result<std::vector<TomlItem>> parse_toml_text(std::string_view text, const std::string& source) {
  const toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    const auto [row, column] = error.source().begin;
    const auto lines = split(text, '\n');
    return syntax_error(fmt::format("{}, line {}, column {}", source, row, column), trimmed(error.description()),
                        row >= 1 && row <= lines.size() ? trimmed(lines[row - 1]) : "");
  }
  std::vector<TomlItem> items;
  collect(parsed.table(), {}, items);
  std::stable_sort(items.begin(), items.end(), [](const TomlItem& a, const TomlItem& b) {
    return std::tuple(a.line, a.column) < std::tuple(b.line, b.column);
  });
  return items;
}

Result<std::vector<TomlItem>> parse_toml(std::string_view text, const std::string& source) {
  if (Result<> safe = precheck_toml(text, source); !safe) return safe.error();
  return ask(kToml, source, std::string(text));
}

std::string joined(const std::vector<std::string>& path) {
  std::string text;
  for (const std::string& part : path) {
    const bool entry = part.size() > 2 && part.front() == '[' && part.back() == ']';
    if (!text.empty() && !entry) text += '.';
    text += part;
  }
  return text;
}

}  // namespace stylet::detail
