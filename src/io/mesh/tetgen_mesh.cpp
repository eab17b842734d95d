// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of TetGen .node and .ele files (Si, TetGen 1.6 manual, section 5.2): a first line with counts, then one line
// per node or tetrahedron; '#' begins a comment; numbering starts at 0 or 1.
#include "detail/input_file.hpp"
#include "detail/text.hpp"
#include "mesh/raw_mesh.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

/// Reads lines of numbers; skips comments and blank lines. Errors name the line.
class NumberLines {
 public:
  explicit NumberLines(const fs::path& path) : file_(path), name_(path.string()) {}
  [[nodiscard]] bool opened() const { return file_.is_open(); }
  [[nodiscard]] std::string place() const { return fmt::format("{}, line {}", name_, line_number_); }

  [[nodiscard]] int number() const { return line_number_; }

  /// The next line's numbers; an error at the end of the file.
  Result<std::vector<double>> next() {
    std::string line;
    while (std::getline(file_, line)) {
      ++line_number_;
      const auto comment = line.find('#');
      if (comment != std::string::npos) line.resize(comment);
      for (char& c : line) {
        if (c == '\t' || c == '\r' || c == ',') c = ' ';
      }
      std::vector<double> numbers;
      for (const auto word : split(line, ' ')) {
        if (word.empty()) continue;
        const auto number = to_number(word);
        if (!number || !std::isfinite(*number)) {
          return input_error(place(), fmt::format("'{}' is not a finite number", word.substr(0, 40)),
                             "Correct the file at that place");
        }
        numbers.push_back(*number);
      }
      if (!numbers.empty()) return numbers;
    }
    return input_error(place(), "the file ends here, more lines are announced",
                       "The file is truncated; export the mesh again");
  }

 private:
  std::ifstream file_;
  std::string name_;
  int line_number_ = 0;
};

Error wrong_line(const NumberLines& lines, std::string what) {
  return input_error(lines.place(), std::move(what), "Correct the file at that place");
}

/// Converts to a whole number 0…2³¹-2; empty if it is not one.
std::optional<Index> whole(double value) {
  if (!(value >= 0.0 && value < 2147483647.0) || value != std::floor(value)) return std::nullopt;
  return static_cast<Index>(value);
}

struct Nodes {
  std::vector<Vec3> points;
  Index first = 0;  ///< number of the first node, 0 or 1
};

Result<Nodes> read_nodes(NumberLines& lines) {
  Result<std::vector<double>> head = lines.next();
  if (!head) return head.error();
  const auto count = whole(head->front());
  if (!count || head->size() < 2 || (*head)[1] != 3.0) {
    return wrong_line(lines, "the first line of a .node file is: number of points, 3, number of attributes, markers");
  }
  Nodes nodes;
  for (Index a = 0; a < *count; ++a) {
    Result<std::vector<double>> line = lines.next();
    if (!line) return line.error();
    if (line->size() < 4)
      return wrong_line(lines, fmt::format("{} numbers, at least 4 are expected (number x y z)", line->size()));
    const auto number = whole(line->front());
    if (a == 0 && (number == Index{0} || number == Index{1})) nodes.first = *number;
    if (number != nodes.first + a)
      return wrong_line(lines,
                        fmt::format("node number {} is out of order, {} is expected", line->front(), nodes.first + a));
    nodes.points.emplace_back((*line)[1], (*line)[2], (*line)[3]);
  }
  return nodes;
}

Result<> read_tets(NumberLines& lines, const Nodes& nodes, RawMesh& raw) {
  Result<std::vector<double>> head = lines.next();
  if (!head) return head.error();
  const auto count = whole(head->front());
  if (!count || head->size() < 2 || ((*head)[1] != 4.0 && (*head)[1] != 10.0)) {
    return wrong_line(
        lines, "the first line of an .ele file is: number of tetrahedra, nodes per tetrahedron (4 or 10), attributes");
  }
  const std::size_t per_tet = (*head)[1] == 10.0 ? 10 : 4;
  const auto attributes = head->size() > 2 ? whole((*head)[2]).value_or(0) : 0;
  constexpr Index most_attributes = 1000;
  if (attributes > most_attributes)
    return wrong_line(lines,
                      fmt::format("{} attributes are announced, at most {} are read", attributes, most_attributes));
  for (Index a = 1; a <= attributes; ++a)
    raw.arrays.push_back({.name = fmt::format("attribute {}", a), .values = {}, .names = {}});
  if (attributes > 0) raw.own = 0;
  raw.array_word = "attribute";
  raw.quadratic = per_tet == 10;
  for (Index t = 0; t < *count; ++t) {
    Result<std::vector<double>> line = lines.next();
    if (!line) return line.error();
    const std::size_t expected = 1 + per_tet + raw.arrays.size();
    if (line->size() < expected)
      return wrong_line(lines, fmt::format("{} numbers, {} are expected", line->size(), expected));
    std::array<Index, 4> tet{};
    for (std::size_t i = 0; i < per_tet; ++i) {
      const auto number = whole((*line)[1 + i]);
      const Index node = number ? *number - nodes.first : -1;
      if (node < 0 || node >= static_cast<Index>(nodes.points.size())) {
        return wrong_line(lines, fmt::format("node number {} is out of range, expected {} to {}", (*line)[1 + i],
                                             nodes.first, nodes.first + static_cast<Index>(nodes.points.size()) - 1));
      }
      if (i < 4) {
        tet[i] = node;
      } else {
        raw.used_elsewhere[node] = true;
      }
    }
    for (std::size_t a = 0; a < raw.arrays.size(); ++a) raw.arrays[a].values.push_back((*line)[1 + per_tet + a]);
    raw.tets.push_back(tet);
    raw.cells.push_back(lines.number());
  }
  return Ok{};
}

}  // namespace

Result<RawMesh> parse_tetgen_mesh(const fs::path& path) {
  const fs::path node_path = fs::path(path).replace_extension(".node"),
                 ele_path = fs::path(path).replace_extension(".ele");
  for (const fs::path& part : {node_path, ele_path}) {
    if (Result<> file = check_input_file(part); !file) {
      return input_error(
          path.string(),
          fmt::format("the second file '{}' cannot be read: {}", part.filename().string(), file.error().what),
          "Keep the .node and the .ele file of a TetGen mesh in the same folder");
    }
  }
  NumberLines node_lines(node_path), ele_lines(ele_path);
  Result<Nodes> nodes = read_nodes(node_lines);
  if (!nodes) return nodes.error();
  RawMesh raw;
  raw.used_elsewhere.assign(nodes->points.size(), false);
  if (Result<> tets = read_tets(ele_lines, *nodes, raw); !tets) return tets.error();
  raw.nodes = std::move(nodes->points);
  raw.cell_word = path == ele_path ? "line" : "line of the .ele file";
  return raw;
}

}  // namespace stylet::detail
