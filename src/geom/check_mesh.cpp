// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "face_table.hpp"
#include "stylet/geom/plausible_size.hpp"
#include "stylet/geom/tet_mesh.hpp"

namespace stylet {
namespace {

// A tetrahedron counts as flat when 6 × volume ≤ kFlat × (longest edge)³; for the regular tetrahedron the ratio is
// 0.71. Rounding of node coordinates to single precision, the coarsest precision of file formats, leaves about this
// much.
constexpr double kFlat = 1e-6;
constexpr double kSmallestMesh_mm = 5.0;  // of a mesh whose unit is known

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string point(const Vec3& x) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g) mm", x[0], x[1], x[2]);
  return text;
}

std::string tet_name(const TetMesh& mesh, Index t) {
  const auto& tet = mesh.tets[t];
  return "tetrahedron " + std::to_string(t) + " (nodes " + std::to_string(tet[0]) + ", " + std::to_string(tet[1]) +
         ", " + std::to_string(tet[2]) + ", " + std::to_string(tet[3]) + "; numbers start at 0)";
}

std::string more(Index others) {
  return others > 0 ? ", and " + std::to_string(others) + " more like it" : std::string();
}

double longest_edge(const TetMesh& mesh, Index t) {
  double longest = 0.0;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      longest = std::max(longest, (mesh.nodes[mesh.tets[t][a]] - mesh.nodes[mesh.tets[t][b]]).norm());
    }
  }
  return longest;
}

Result<> check_sizes(const TetMesh& mesh, const std::string& where) {
  if (mesh.nodes.empty() || mesh.tets.empty()) {
    return input_error(where,
                       "the mesh is empty: " + std::to_string(mesh.nodes.size()) + " nodes and " +
                           std::to_string(mesh.tets.size()) + " tetrahedra",
                       "Give a volume mesh of linear tetrahedra, or fill the surface mesh with tetrahedra first");
  }
  if (mesh.regions.empty() || mesh.tet_region.size() != mesh.tets.size()) {
    return input_error(where,
                       "the mesh names " + std::to_string(mesh.regions.size()) + " regions and gives a region to " +
                           std::to_string(mesh.tet_region.size()) + " of " + std::to_string(mesh.tets.size()) +
                           " tetrahedra",
                       "Give every tetrahedron the number of a named region");
  }
  return Ok{};
}

Result<> check_numbers(const TetMesh& mesh, const std::string& where) {
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (const Index a : mesh.tets[t]) {
      if (a < 0 || a >= mesh.node_count()) {
        return input_error(where + ", " + tet_name(mesh, t),
                           "node number " + std::to_string(a) + " is out of range, expected 0 to " +
                               std::to_string(mesh.node_count() - 1),
                           "Check whether the file counts nodes from 0 or from 1, and whether it is complete");
      }
    }
    const int region = mesh.tet_region[t];
    if (region < 0 || region >= static_cast<int>(mesh.regions.size())) {
      return input_error(where + ", " + tet_name(mesh, t),
                         "region number " + std::to_string(region) + " is out of range, expected 0 to " +
                             std::to_string(mesh.regions.size() - 1),
                         "Give every tetrahedron the number of a named region");
    }
  }
  return Ok{};
}

Result<> check_coordinates(const TetMesh& mesh, const std::string& where) {
  Eigen::AlignedBox3d box;
  for (Index a = 0; a < mesh.node_count(); ++a) {
    if (!mesh.nodes[a].allFinite()) {
      return input_error(where + ", node " + std::to_string(a) + " (numbers start at 0)",
                         "a coordinate is not a finite number: " + point(mesh.nodes[a]),
                         "Repair the file or convert it again; such values usually come from a failed conversion");
    }
    box.extend(mesh.nodes[a]);
  }
  return check_size(box.sizes().maxCoeff(), where, "the mesh", 1.0, kSmallestMesh_mm);
}

// This check also catches a tetrahedron that names a node twice and whose volume is not zero because of rounding.
Result<> check_repeated_nodes(const TetMesh& mesh, const std::string& where) {
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    auto tet = mesh.tets[t];
    std::sort(tet.begin(), tet.end());
    const auto twice = std::adjacent_find(tet.begin(), tet.end());
    if (twice != tet.end()) {
      return input_error(where + ", " + tet_name(mesh, t),
                         "node " + std::to_string(*twice) + " is named twice, expected four different nodes",
                         "Remove the degenerate tetrahedron or mesh the body again");
    }
  }
  return Ok{};
}

Result<> check_duplicates(const TetMesh& mesh, const std::string& where) {
  std::vector<std::pair<std::array<Index, 4>, Index>> keys;
  keys.reserve(mesh.tets.size());
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    auto key = mesh.tets[t];
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  Index first = -1;
  Index second = -1;
  Index count = 0;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[i - 1].first) continue;
    if (count++ == 0) first = keys[i - 1].second, second = keys[i].second;
  }
  if (count > 0) {
    return input_error(where + ", " + tet_name(mesh, second),
                       "it is a duplicate of tetrahedron " + std::to_string(first) + more(count - 1),
                       "Remove the duplicate; such pairs usually come from merging two exports of one mesh");
  }
  return Ok{};
}

Result<> check_volumes(const TetMesh& mesh, const std::string& where) {
  Index first_inverted = -1;
  Index first_flat = -1;
  Index inverted = 0;
  Index flat = 0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const double six_volumes = 6.0 * tet_volume(mesh, t);
    const double edge = longest_edge(mesh, t);
    const double limit = kFlat * edge * edge * edge;
    if (std::abs(six_volumes) <= limit) {
      if (flat++ == 0) first_flat = t;
    } else if (six_volumes < 0.0) {
      if (inverted++ == 0) first_inverted = t;
    }
  }
  if (inverted == mesh.tet_count()) {
    return input_error(where,
                       "all " + std::to_string(inverted) + " tetrahedra are inverted, the first with a volume of " +
                           number(tet_volume(mesh, 0)) + " mm³: the nodes are listed in the opposite order",
                       "Swap two nodes of every tetrahedron");
  }
  if (inverted > 0) {
    return input_error(where + ", " + tet_name(mesh, first_inverted),
                       "it is inverted: its volume is " + number(tet_volume(mesh, first_inverted)) +
                           " mm³, expected above 0" + more(inverted - 1),
                       "Swap two of its nodes if only their order is wrong, or mesh the body again");
  }
  if (flat > 0) {
    return input_error(where + ", " + tet_name(mesh, first_flat),
                       "it is flat: its volume is " + number(tet_volume(mesh, first_flat)) +
                           " mm³ with a longest edge of " + number(longest_edge(mesh, first_flat)) + " mm" +
                           more(flat - 1),
                       "Remove flat tetrahedra with the meshing program's optimiser, or mesh the body again");
  }
  return Ok{};
}

Result<> check_faces(const TetMesh& mesh, const std::string& where) {
  const auto sides = detail::sorted_face_sides(mesh);
  const auto face_name = [](const std::array<Index, 3>& key) {
    return "face of nodes " + std::to_string(key[0]) + ", " + std::to_string(key[1]) + ", " + std::to_string(key[2]) +
           " (numbers start at 0)";
  };
  // True when the outward order of the side's corners is an even permutation of the sorted key.
  const auto even = [&mesh](const detail::FaceSide& side) {
    const auto& tet = mesh.tets[side.tet];
    const auto& corner = kFaceVertices[side.local];
    const Index a = tet[corner[0]];
    const Index b = tet[corner[1]];
    const Index c = tet[corner[2]];
    return (a < b && b < c) || (b < c && c < a) || (c < a && a < b);
  };
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].key == sides[i].key) ++end;
    if (end - i > 2) {
      return input_error(where + ", " + face_name(sides[i].key),
                         "the face is shared by " + std::to_string(end - i) + " tetrahedra (" +
                             std::to_string(sides[i].tet) + ", " + std::to_string(sides[i + 1].tet) + ", " +
                             std::to_string(sides[i + 2].tet) + (end - i > 3 ? ", …" : "") + "), expected at most 2",
                         "Remove overlapping tetrahedra or mesh the body again");
    }
    if (end - i == 2 && even(sides[i]) == even(sides[i + 1])) {
      return input_error(where + ", " + face_name(sides[i].key),
                         "tetrahedra " + std::to_string(sides[i].tet) + " and " + std::to_string(sides[i + 1].tet) +
                             " lie on the same side of the face they share: they overlap",
                         "Remove overlapping tetrahedra or mesh the body again");
    }
    i = end;
  }
  return Ok{};
}

Result<> check_references(const TetMesh& mesh, const std::string& where) {
  std::vector<char> used(mesh.nodes.size(), 0);
  for (const auto& tet : mesh.tets) {
    for (const Index a : tet) used[a] = 1;
  }
  const auto unused = static_cast<Index>(std::count(used.begin(), used.end(), 0));
  if (unused > 0) {
    const auto a = static_cast<Index>(std::find(used.begin(), used.end(), 0) - used.begin());
    return input_error(where + ", node " + std::to_string(a) + " (numbers start at 0)",
                       "no tetrahedron uses the node at " + point(mesh.nodes[a]) + more(unused - 1),
                       "Remove unreferenced nodes (many programs call this cleaning or compacting the mesh)");
  }
  return Ok{};
}

}  // namespace

Result<> check_mesh(const TetMesh& mesh, const std::string& where) {
  // Each check relies on the checks before it having passed.
  for (const auto check : {check_sizes, check_numbers, check_coordinates, check_repeated_nodes, check_duplicates,
                           check_volumes, check_faces, check_references}) {
    if (auto result = check(mesh, where); !result) return result;
  }
  return Ok{};
}

}  // namespace stylet
