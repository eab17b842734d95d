// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_table.hpp"

#include <algorithm>
#include <tuple>

namespace stylet::detail {

std::vector<FaceSide> sorted_face_sides(const TetMesh& mesh) {
  const auto side_of = [&mesh](Index t, int local) {
    const auto& tet = mesh.tets[t];
    const auto& corner = kFaceVertices[local];
    std::array<Index, 3> key{tet[corner[0]], tet[corner[1]], tet[corner[2]]};
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    if (key[1] > key[2]) std::swap(key[1], key[2]);
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    return FaceSide{key, t, local};
  };

  std::vector<std::size_t> begin(mesh.nodes.size() + 1, 0);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int local = 0; local < 4; ++local) ++begin[side_of(t, local).key[0] + 1];
  }
  for (std::size_t a = 1; a < begin.size(); ++a) begin[a] += begin[a - 1];

  std::vector<FaceSide> sides(4 * mesh.tets.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int local = 0; local < 4; ++local) {
      const FaceSide side = side_of(t, local);
      sides[next[side.key[0]]++] = side;
    }
  }
  for (std::size_t a = 0; a + 1 < begin.size(); ++a) {
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin[a]),
              sides.begin() + static_cast<std::ptrdiff_t>(begin[a + 1]), [](const FaceSide& p, const FaceSide& q) {
                return std::tie(p.key[1], p.key[2], p.tet, p.local) < std::tie(q.key[1], q.key[2], q.tet, q.local);
              });
  }
  return sides;
}

}  // namespace stylet::detail
