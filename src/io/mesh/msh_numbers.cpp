// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/msh_numbers.hpp"

#include "detail/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <optional>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

/// Reads the numbers in the list of elements of an MSH 1 or 2 file. Other sections are skipped line by line.
class ElementList {
 public:
  explicit ElementList(const fs::path& path) : file_(path, std::ios::binary) {
    for (std::string line; std::getline(file_, line);) {
      const std::string mark = trimmed(line);
      if (mark == "$MeshFormat") read_format();
      if (mark != "$Elements" && mark != "$ELM") continue;
      there_ = version_ < 3.0;
      break;
    }
    std::string announced;
    if (there_ && std::getline(file_, announced)) count_ = static_cast<long long>(to_number(announced).value_or(-1));
  }

  /// The announced number of elements; empty if the file has another version or no elements.
  [[nodiscard]] std::optional<std::size_t> count() const {
    if (!there_ || count_ < 0) return std::nullopt;
    return static_cast<std::size_t>(count_);
  }

  /// The numbers of the elements in the file's order, up to the first unreadable place.
  std::vector<std::size_t> numbers(const std::function<int(int)>& nodes_of) {
    std::vector<std::size_t> all;
    while (static_cast<long long>(all.size()) < count_ && read_block(nodes_of, all)) continue;
    return all;
  }

 private:
  void read_format() {
    int binary = 0, size = 0;
    file_ >> version_ >> binary >> size;
    std::string rest;
    std::getline(file_, rest);
    binary_ = binary == 1;
    int one = 1;
    if (binary_) file_.read(reinterpret_cast<char*>(&one), sizeof one);
    swapped_ = one != 1;
  }

  /// Reads one element, or in binary MSH 2 several elements with a common header.
  bool read_block(const std::function<int(int)>& nodes_of, std::vector<std::size_t>& all) {
    int number = 0, type = 0, tags = 0, elements = 1;
    if (version_ < 2.0) {
      int physical = 0, entity = 0, nodes = 0;
      const bool good = next(number) && next(type) && next(physical) && next(entity) && next(nodes) && skip(nodes);
      if (good) all.push_back(static_cast<std::size_t>(number));
      return good;
    }
    if (binary_ ? !(next(type) && next(elements) && next(tags)) : !(next(number) && next(type) && next(tags)))
      return false;
    const int nodes = nodes_of(type);
    for (int e = 0; e < elements; ++e) {
      if ((binary_ && !next(number)) || !skip(tags) || !skip(nodes)) return false;
      all.push_back(static_cast<std::size_t>(number));
    }
    return true;
  }

  bool next(int& value) {
    if (!binary_) return static_cast<bool>(file_ >> value);
    unsigned raw = 0;
    if (!file_.read(reinterpret_cast<char*>(&raw), sizeof raw)) return false;
    if (swapped_) raw = raw << 24 | (raw & 0xff00u) << 8 | (raw >> 8 & 0xff00u) | raw >> 24;
    value = std::bit_cast<int>(raw);
    return true;
  }

  bool skip(int count) {
    int ignored = 0;
    for (int k = 0; k < count; ++k) {
      if (!next(ignored)) return false;
    }
    return true;
  }

  std::ifstream file_;
  double version_ = 1.0;  // of a file without $MeshFormat
  bool binary_ = false;
  bool swapped_ = false;  // the file has the other byte order
  bool there_ = false;
  long long count_ = -1;
};

std::optional<std::size_t> repeated(std::vector<std::size_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
  if (twice == numbers.end()) return std::nullopt;
  return *twice;
}

Error has_number_twice(const fs::path& path, std::size_t number) {
  return input_error(fmt::format("{}, element {}", path.string(), number),
                     "two elements have this number, and gmsh would drop one of them",
                     "Give every element a different number, triangles and lines included, or export the mesh again");
}

}  // namespace

Result<> check_element_numbers(const fs::path& path, std::vector<std::size_t> taken,
                               const std::function<int(int type)>& nodes_of) {
  if (const auto number = repeated(taken)) return has_number_twice(path, *number);
  ElementList list(path);
  const auto announced = list.count();
  if (!announced || *announced == taken.size()) return Ok{};
  auto numbers = list.numbers(nodes_of);
  if (const auto number = repeated(numbers)) return has_number_twice(path, *number);
  return input_error(path.string(),
                     fmt::format("the file announces {} elements and gmsh has read {}", *announced, taken.size()),
                     "The file is truncated or damaged; copy or export it again");
}

}  // namespace stylet::detail
