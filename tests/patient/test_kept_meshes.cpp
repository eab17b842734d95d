// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/patient_mesh.hpp"

#include "support/folder.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace fs = std::filesystem;

namespace stylet {
namespace {

/// A folder for kept meshes, and whether a mesh is made anew or taken from there.
class KeptMeshes : public ::testing::Test {
 protected:
  void SetUp() override { setenv("STYLET_CACHE", folder_.path().c_str(), 1); }
  void TearDown() override { unsetenv("STYLET_CACHE"); }
  MeshedAnatomy mesh_of(int nodes) {
    Scenario scenario;
    scenario.patient.source = "phantom";
    scenario.mesh.preset = MeshPreset::paper;
    scenario.mesh.nodes = nodes;
    meshed_ = false;
    return test::value_of(mesh_patient(scenario, [this](std::string_view, double) { meshed_ = true; }));
  }
  [[nodiscard]] bool meshed() const { return meshed_; }
  [[nodiscard]] std::vector<std::string> files() const { return test::names_in(folder_.path()); }
  [[nodiscard]] fs::path path(const std::string& file) const { return folder_ / file; }

 private:
  test::Folder folder_;
  bool meshed_ = false;
};

void expect_same(const MeshedAnatomy& a, const MeshedAnatomy& b) {
  EXPECT_EQ(a.mesh.nodes, b.mesh.nodes);
  EXPECT_EQ(a.mesh.tets, b.mesh.tets);
  EXPECT_EQ(a.mesh.tet_region, b.mesh.tet_region);
  EXPECT_EQ(a.mesh.regions, b.mesh.regions);
  EXPECT_EQ(a.report.notes, b.report.notes);
  EXPECT_EQ(a.report.surface_max_mm, b.report.surface_max_mm);
  EXPECT_EQ(a.report.quality.dihedral_histogram, b.report.quality.dihedral_histogram);
  ASSERT_EQ(a.report.regions.size(), b.report.regions.size());
  for (std::size_t r = 0; r < a.report.regions.size(); ++r)
    EXPECT_EQ(a.report.regions[r].input_volume_cc, b.report.regions[r].input_volume_cc);
}

TEST_F(KeptMeshes, are_those_that_were_made_for_the_same_options_only) {
  const MeshedAnatomy made = mesh_of(400);
  EXPECT_TRUE(meshed());
  const MeshedAnatomy kept = mesh_of(400);
  EXPECT_FALSE(meshed());
  expect_same(made, kept);
  mesh_of(450);
  EXPECT_TRUE(meshed());
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(KeptMeshes, that_are_damaged_are_made_anew) {
  const MeshedAnatomy made = mesh_of(400);
  const fs::path file = path(files().at(0));
  fs::resize_file(file, fs::file_size(file) / 2);
  const MeshedAnatomy again = mesh_of(400);
  EXPECT_TRUE(meshed());
  expect_same(made, again);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(5000).put('x');
  mesh_of(400);
  EXPECT_TRUE(meshed());
  mesh_of(400);
  EXPECT_FALSE(meshed());
}

TEST_F(KeptMeshes, are_not_needed_where_they_cannot_be_written) {
  setenv("STYLET_CACHE", "/proc/no/such/folder", 1);
  expect_same(mesh_of(400), mesh_of(400));
  EXPECT_TRUE(meshed());
}

}  // namespace
}  // namespace stylet
