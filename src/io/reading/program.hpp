// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "reading/ask.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

/// The program that reads files of unknown origin: it takes one request, gives up all rights but reading files and
/// answering (confine.hpp), carries out the task and ends.
namespace stylet::detail {

/// The parsers by the names of their tasks.
class TaskTable {
 public:
  /// @param parse function of a path and the task's arguments that returns a Result of the task's answer
  template <class Answer, class... Arguments, class Parse>
  void add(const Task<Answer, Arguments...>& task, Parse parse) {
    parsers_[std::string(task.name)] = [task, parse](std::string_view bytes) {
      WireReader wire(bytes);
      std::string path;
      std::tuple<Arguments...> arguments;
      wire(path);
      std::apply([&](Arguments&... values) { wire(values...); }, arguments);
      return bytes_of<Answer>(path, task.cure, [&] {
        return std::apply([&](const Arguments&... values) { return parse(std::filesystem::path(path), values...); },
                          arguments);
      });
    };
  }

  /// The bytes of the task's Result. Throws std::out_of_range for a name that is not in the table.
  [[nodiscard]] std::string answer(std::string_view task, std::string_view arguments) const {
    return parsers_.at(std::string(task))(arguments);
  }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, parser] : parsers_) names.push_back(name);
    return names;
  }

 private:
  /// The bytes of the result of a parser, or of an error if it throws.
  template <class Answer, class Parse>
  static std::string bytes_of(const std::filesystem::path& path, const char* cure, const Parse& parse) {
    Result<Answer> result = [&]() -> Result<Answer> {
      try {
        return parse();
      } catch (const std::bad_alloc&) {
        return out_of_memory(path);
      } catch (...) {
        return threw(path, cure);
      }
    }();
    return to_bytes(result);
  }

  std::map<std::string, std::function<std::string(std::string_view)>> parsers_;
};

/// Carries out the request on the standard input. @return exit status of the program
int run_reading_program(TaskTable table);

}  // namespace stylet::detail
