// SPDX-License-Identifier: GPL-3.0-or-later
// Tests what the mesher guarantees on real patients: eight label masks of prostate zones, two RT structure sets, and
// the demo patient.
#include "mesh_checks.hpp"
#include "stylet/io/contours_io.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/phantom/phantom.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace stylet {
namespace {

std::filesystem::path data_folder() {
  const char* named = std::getenv("STYLET_SHARED_DATA");
  return named != nullptr ? named : STYLET_SHARED_DATA_DEFAULT;
}

/// Path of a case below the data folder; empty for the demo patient, which the program makes itself.
std::string path_of(const std::string& name) {
  if (name == "demo") return "";
  if (name == "robustbrachy") return "robustbrachy_hdr_phantom/SS001.dcm";
  if (name == "rando") return "slicerrt_rando_rtstruct";
  return "msd_prostate_masks/" + name + ".nii.gz";
}

void print(const std::string& name, const MeshReport& r) {
  const MeshQuality& q = r.quality;
  std::printf(
      "%s: %d nodes, %d tets, dihedral %.1f...%.1f deg, radius ratio %.3f, edges %.2f...%.1f mm, surface %.2f mm mean "
      "%.2f mm max, %.1f s\n",
      name.c_str(), q.nodes, q.tets, q.dihedral_deg.min, q.dihedral_deg.max, q.radius_ratio_min, q.edge_mm.min,
      q.edge_mm.max, r.surface_mean_mm, r.surface_max_mm, r.seconds);
  for (const RegionReport& g : r.regions) {
    std::printf("  %-16s %6d tets %9.2f cc of %9.2f cc\n", g.name.c_str(), g.tets, g.volume_cc, g.input_volume_cc);
  }
}

Result<MeshedAnatomy> mesh_case(const std::string& name, MeshOptions options) {
  const std::filesystem::path path = data_folder() / path_of(name);
  if (name == "demo") return mesh_contours(demo_patient(), options);
  if (name.starts_with("prostate_")) {
    auto image = read_label_image(path);
    if (!image) return image.error();
    options.regions = {{"1", "peripheral_zone"}, {"2", "transition_zone"}};
    return mesh_labels(*image, options);
  }
  auto contours = read_rtstruct(path);
  if (!contours) return contours.error();
  return mesh_contours(*contours, options);
}

class RealCase : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string path = path_of(GetParam());
    if (!path.empty() && !std::filesystem::exists(data_folder() / path)) {
      GTEST_SKIP() << "no real case at " << (data_folder() / path) << " (set STYLET_SHARED_DATA to their folder)";
    }
  }

  void expect_promise(Index nodes, MeshPreset preset, const testing::Promise& promise) {
    MeshOptions options;
    options.nodes = preset == MeshPreset::paper || nodes == 3000 ? 0 : nodes;
    options.preset = preset;
    const auto m = mesh_case(GetParam(), options);
    ASSERT_TRUE(m.ok()) << m.error().message();
    print(GetParam(), m->report);
    testing::expect_kept(*m, nodes, promise);
  }
};

constexpr const char* kCases[] = {"prostate_00", "prostate_14",  "prostate_17", "prostate_21",
                                  "prostate_25", "prostate_41",  "prostate_44", "prostate_46",
                                  "rando",       "robustbrachy", "demo"};

TEST_P(RealCase, at_default_size_angles_are_12_to_165_degrees_and_volumes_met) {
  expect_promise(3000, MeshPreset::standard, {});
}

TEST_P(RealCase, the_paper_preset_has_570_nodes_and_angles_above_9_degrees) {
  expect_promise(
      570, MeshPreset::paper,
      {.smallest_angle = 9.9, .largest_angle = 170, .region_volume = 0.1, .total_volume = 0.1, .nodes = 0.026});
}

INSTANTIATE_TEST_SUITE_P(All, RealCase, ::testing::ValuesIn(kCases),
                         [](const auto& i) { return std::string(i.param); });

/// Angles and node count are guaranteed at any size, volumes from the default size upwards.
class AnySize : public RealCase {};

TEST_P(AnySize, angles_and_node_count_hold_from_1000_to_10000_nodes) {
  for (const Index nodes : {1000, 10000}) {
    const double volume = nodes < 3000 ? 0.2 : 0.08;
    expect_promise(nodes, MeshPreset::standard,
                   {.smallest_angle = 8, .largest_angle = 172, .region_volume = volume, .total_volume = 0.03});
  }
}

INSTANTIATE_TEST_SUITE_P(Some, AnySize, ::testing::Values("prostate_41", "robustbrachy", "rando", "demo"),
                         [](const auto& i) { return std::string(i.param); });

TEST(RealMask, meshing_twice_gives_the_same_mesh) {
  if (!std::filesystem::exists(data_folder() / path_of("prostate_00")))
    GTEST_SKIP() << "no real cases at " << data_folder() << " (set STYLET_SHARED_DATA to their folder)";
  const auto a = mesh_case("prostate_00", {});
  const auto b = mesh_case("prostate_00", {});
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->mesh.nodes, b->mesh.nodes);
  EXPECT_EQ(a->mesh.tets, b->mesh.tets);
}

}  // namespace
}  // namespace stylet
