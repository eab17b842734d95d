// SPDX-License-Identifier: GPL-3.0-or-later
#include "validators.hpp"

#include "command.hpp"

#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace stylet::cli {

namespace {

/// Parses a number. @return false unless the whole text is one
template <class Number>
bool parse(const std::string& text, Number& number) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end;
}

}  // namespace

// A validator returns an error message, or an empty text if the value is accepted.

CLI::Validator number_between(double lo, double hi, const std::string& unit) {
  return {[=](const std::string& text) {
            double number = 0;
            if (parse(text, number) && number >= lo && number <= hi) return std::string();
            return fmt::format("'{}' is not a number from {} to {}{}{}", text, lo, hi, unit.empty() ? "" : " ", unit);
          },
          ""};
}

CLI::Validator whole_number_between(long long lo, long long hi) {
  return {[=](const std::string& text) {
            long long number = 0;
            if (parse(text, number) && number >= lo && number <= hi) return std::string();
            return fmt::format("'{}' is not a whole number from {} to {}", text, lo, hi);
          },
          ""};
}

CLI::Validator one_of(std::vector<std::string> words) {
  return {[words = std::move(words)](const std::string& text) {
            if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
            const std::string nearest = nearest_name(text, words);
            return fmt::format("'{}' is not one of {}{}", text, fmt::join(words, ", "),
                               nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
          },
          ""};
}

void add_volume_option(CLI::App& app, int& volume) {
  option(&app, "--volume", volume, "N",
         "Number of the volume, from 1, in a mask file that contains several (default: the only volume)")
      ->check(whole_number_between(1, 1'000'000));
}

void add_regions_from_option(CLI::App& app, std::string& name) {
  option(&app, "--regions-from", name, "NAME",
         "Array of a mesh file that is its regions: cell array (VTU, VTK), $ElementData (gmsh), 'attribute N' "
         "(TetGen) (default: the format's own regions, or the only array of whole numbers that can be them)");
}

}  // namespace stylet::cli
