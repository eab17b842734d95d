// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_patient.hpp"

#include <algorithm>

using namespace stylet;
using namespace stylet::test;

namespace {

struct Held {
  TetMesh mesh;
  Supports supports;

  explicit Held(const Scenario::Fixed& fixed, TetMesh mesh_ = box_patient(), const Vec3& entry = Vec3(0, 5, 0))
      : mesh(std::move(mesh_)) {
    const Topology topology(mesh);
    const int gland = mesh.region_index("prostate");
    const std::vector<int> target = gland >= 0 ? std::vector<int>{gland} : std::vector<int>{};
    auto found = find_supports(mesh, topology, fixed, target, {entry}, {Vec3::UnitZ()});
    if (!found) throw std::runtime_error(found.error().message());
    supports = std::move(*found);
  }

  [[nodiscard]] bool holds(const Vec3& x) const {
    for (Index n = 0; n < mesh.node_count(); ++n) {
      if ((mesh.nodes[static_cast<std::size_t>(n)] - x).norm() < 1e-9)
        return std::binary_search(supports.nodes.begin(), supports.nodes.end(), n);
    }
    ADD_FAILURE() << "no node at " << x.transpose();
    return false;
  }
  [[nodiscard]] std::string words() const {
    std::string all;
    for (const auto& sentence : supports.description) all += sentence + "\n";
    return all;
  }
};

Scenario::Fixed outer(const std::string& mode) {
  Scenario::Fixed fixed;
  fixed.outer = choice<OuterSupport>(mode).value();
  return fixed;
}

}  // namespace

TEST(Supports, a_bone_is_held_whole_and_rigid_for_the_needle) {
  const Held held(outer("none"));
  std::vector<Index> bone;
  for (std::size_t t = 0; t < held.mesh.tets.size(); ++t) {
    if (held.mesh.tet_region[t] == 2) bone.insert(bone.end(), held.mesh.tets[t].begin(), held.mesh.tets[t].end());
  }
  std::sort(bone.begin(), bone.end());
  bone.erase(std::unique(bone.begin(), bone.end()), bone.end());
  EXPECT_EQ(held.supports.nodes, bone);
  EXPECT_EQ(held.supports.rigid_regions, std::vector<int>{2});
  EXPECT_EQ(held.words(), "Region pubic_arch is held: " + std::to_string(bone.size()) + " nodes.\n");
}

TEST(Supports, auto_leaves_the_outer_faces_free_where_there_is_a_pubic_arch_and_holds_them_where_not) {
  EXPECT_EQ(Held(outer("auto")).supports.nodes, Held(outer("none")).supports.nodes);
  const Held without(outer("auto"), box_patient(false));
  EXPECT_EQ(without.supports.nodes, Held(outer("sides"), box_patient(false)).supports.nodes);
  EXPECT_TRUE(without.holds({30, 0, 40}));
  EXPECT_TRUE(without.supports.rigid_regions.empty());
}

TEST(Supports, sides_leave_the_perineal_face_free) {
  const Held held(outer("sides"), box_patient(false), {0, 5, 0});
  EXPECT_TRUE(held.holds({30, 0, 50}));
  EXPECT_TRUE(held.holds({-30, 0, 50}));
  EXPECT_TRUE(held.holds({0, 30, 50}));
  EXPECT_TRUE(held.holds({0, 0, 60})) << "superior";
  for (const double x : {-20.0, 0.0, 20.0}) {
    for (const double y : {-20.0, 0.0, 20.0}) EXPECT_FALSE(held.holds({x, y, 0})) << x << " " << y;
  }
  EXPECT_FALSE(held.holds({0, 0, 30})) << "inside";
  EXPECT_SAYS(held.words(), "The outer faces of the body are held: ");
  EXPECT_SAYS(held.words(), "perineal face");
  EXPECT_SAYS(held.words(), "30 mm of an entry are free");
}

TEST(Supports, sides_leave_the_surroundings_of_an_entry_free) {
  const Held below(outer("sides"), box_patient(false), {0, 5, 0});
  const Held beside(outer("sides"), box_patient(false), {30, 0, 50});
  EXPECT_TRUE(below.holds({30, 0, 50}));
  EXPECT_FALSE(beside.holds({30, 0, 50}));
  EXPECT_FALSE(beside.holds({30, 10, 40}));
  EXPECT_TRUE(beside.holds({-30, 0, 50})) << "the other side is held as before";
}

TEST(Supports, sides_of_unnamed_tissue_are_its_far_half_seen_along_the_needle) {
  TetMesh mesh = box_patient(false);
  mesh.regions = {"liver", "tumour"};
  const Held held(outer("sides"), mesh);
  EXPECT_TRUE(held.holds({30, 0, 50}));
  EXPECT_TRUE(held.holds({0, 0, 60}));
  EXPECT_FALSE(held.holds({30, 0, 20}));
  EXPECT_FALSE(held.holds({0, 0, 0}));
  EXPECT_SAYS(held.words(), "far half, seen along the needle");
}

TEST(Supports, all_holds_every_outer_face) {
  const Held held(outer("all"), box_patient(false));
  EXPECT_EQ(held.supports.nodes.size(), 7u * 7u * 7u - 5u * 5u * 5u);
  EXPECT_EQ(held.words(), "All outer faces are held: 218 nodes.\n");
}

TEST(Supports, a_box_holds_the_nodes_inside_it_and_no_bone_grows_from_it) {
  Scenario::Fixed fixed = outer("none");
  fixed.box_mm = {-31, -31, 49, 31, 31, 61};
  const Held held(fixed, box_patient(false));
  EXPECT_EQ(held.supports.nodes.size(), 2u * 49u);
  EXPECT_TRUE(held.supports.rigid_regions.empty());
  EXPECT_EQ(held.words(), "The nodes inside the box fixed.box_mm are held: 98 nodes.\n");
  fixed.box_mm = {100, 100, 100, 110, 110, 110};
  const TetMesh mesh = box_patient(false);
  const auto refused = find_supports(mesh, Topology(mesh), fixed, {1}, {}, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_SAYS(refused.error().message(), "there is no node inside the box");
}

TEST(Supports, regions_named_in_the_scenario_replace_the_bones) {
  Scenario::Fixed fixed = outer("none");
  fixed.regions = {"prostate"};
  const Held held(fixed);
  EXPECT_EQ(held.supports.rigid_regions, std::vector<int>{1});
  EXPECT_FALSE(held.holds({0, -30, 30})) << "the arch is no longer held";
  EXPECT_SAYS(held.words(), "Region prostate is held");
}
