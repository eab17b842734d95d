// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"
#include "stylet/mesher/mesher.hpp"

#include <gtest/gtest.h>

#include <set>

namespace stylet::testing {

inline const RegionReport& region(const MeshedAnatomy& m, const std::string& name) {
  for (const RegionReport& r : m.report.regions) {
    if (r.name == name) return r;
  }
  ADD_FAILURE() << "no region " << name;
  static const RegionReport none;
  return none;
}

inline bool has_region(const MeshedAnatomy& m, const std::string& name) { return m.mesh.region_index(name) >= 0; }

inline bool has_note(const MeshedAnatomy& m, const std::string& part) {
  for (const std::string& n : m.report.notes) {
    if (n.find(part) != std::string::npos) return true;
  }
  return false;
}

/// All nodes of the elements of a region.
inline std::set<Index> nodes_of(const TetMesh& mesh, int region) {
  std::set<Index> nodes;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (mesh.tet_region[t] == region) nodes.insert(mesh.tets[t].begin(), mesh.tets[t].end());
  }
  return nodes;
}

/// Guaranteed properties of a mesh: it is valid, has the wanted number of nodes, and its angles and volumes are in
/// range.
struct Promise {
  double smallest_angle = 12, largest_angle = 165;
  double region_volume = 0.08, total_volume = 0.03;
  double nodes = 0.03;
};

inline void expect_kept(const MeshedAnatomy& m, Index wanted, const Promise& promise = {}) {
  const auto ok = check_mesh(m.mesh, "mesh");
  EXPECT_TRUE(ok.ok()) << (ok.ok() ? "" : ok.error().message());
  EXPECT_NEAR(m.mesh.node_count(), wanted, promise.nodes * wanted);
  const MeshQuality q = mesh_quality(m.mesh);
  EXPECT_GE(q.dihedral_deg.min, promise.smallest_angle);
  EXPECT_LE(q.dihedral_deg.max, promise.largest_angle);
  EXPECT_LE(q.fraction_below_12_deg, 0.001);
  EXPECT_EQ(m.report.quality.nodes, q.nodes);
  double volume = 0, input = 0;
  for (std::size_t k = 0; k < m.report.regions.size(); ++k) {
    const RegionReport& r = m.report.regions[k];
    EXPECT_EQ(r.name, m.mesh.regions[k]);
    EXPECT_GT(r.tets, 0);
    EXPECT_NEAR(r.volume_cc, q.region_volume_cc[k], 1e-9);
    if (r.input_volume_cc == 0) continue;
    EXPECT_NEAR(r.volume_cc / r.input_volume_cc, 1, promise.region_volume) << r.name;
    volume += r.volume_cc;
    input += r.input_volume_cc;
  }
  EXPECT_NEAR(volume / input, 1, promise.total_volume);
}

}  // namespace stylet::testing
