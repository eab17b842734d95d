// SPDX-License-Identifier: GPL-3.0-or-later
// Tests with real cases: every file is read as its source describes it, or fails with the right message.
#include "files.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/geom/structure_slices.hpp"
#include "stylet/io/input.hpp"

#include <cstdlib>
#include <map>
#include <set>

using namespace stylet;
using namespace stylet::test;

namespace {

fs::path data_folder() {
  const char* given = std::getenv("STYLET_SHARED_DATA");
  return given != nullptr ? fs::path(given) : fs::path(STYLET_SHARED_DATA_DEFAULT);
}

class SharedData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory(data_folder())) {
      GTEST_SKIP() << "no real cases at " << data_folder() << " (set STYLET_SHARED_DATA to their folder)";
    }
  }
};

double volume_cc(const Roi& roi) {
  double area = 0.0;
  std::set<double> heights;
  for (const Contour& c : roi.contours) {
    double twice = 0.0;
    for (std::size_t i = 0; i < c.points.size(); ++i) {
      const Vec3 &a = c.points[i], &b = c.points[(i + 1) % c.points.size()];
      twice += a.x() * b.y() - a.y() * b.x();
    }
    area += std::abs(twice) / 2.0;
    heights.insert(c.points[0].z());
  }
  const double gap = (*heights.rbegin() - *heights.begin()) / static_cast<double>(heights.size() - 1);
  return area * gap / 1000.0;
}

}  // namespace

TEST_F(SharedData, prostate_masks_have_the_volume_extent_and_tilt_of_their_source) {
  struct Case {
    const char* name;
    double volume_cc, tilt_deg;
    Vec3 extent;
  };
  for (const Case& c : {Case{"00", 47.3, 16.8, Vec3(45.6, 36.6, 56.0)}, Case{"14", 48.4, 0.0, Vec3(49.4, 36.9, 50.4)},
                        Case{"17", 34.3, 0.0, Vec3(45.0, 36.2, 46.8)}, Case{"21", 54.2, 0.0, Vec3(50.0, 41.2, 54.0)},
                        Case{"25", 67.2, 0.0, Vec3(51.2, 42.5, 68.4)}, Case{"41", 47.8, 0.1, Vec3(51.0, 39.0, 48.0)},
                        Case{"44", 43.4, 0.0, Vec3(50.0, 45.0, 39.6)}, Case{"46", 35.1, 0.0, Vec3(46.9, 33.8, 39.6)}}) {
    SCOPED_TRACE(c.name);
    const auto image =
        read_label_image(data_folder() / "msd_prostate_masks" / (std::string("prostate_") + c.name + ".nii.gz"));
    ASSERT_TRUE(image.ok()) << why(image);
    Eigen::AlignedBox3d voxels;
    std::set<int> labels;
    std::size_t n = 0, count = 0;
    for (int k = 0; k < image->size[2]; ++k) {
      for (int j = 0; j < image->size[1]; ++j) {
        for (int i = 0; i < image->size[0]; ++i, ++n) {
          if (image->labels[n] == 0) continue;
          labels.insert(image->labels[n]);
          voxels.extend(Vec3(i, j, k));
          ++count;
        }
      }
    }
    EXPECT_EQ(labels, (std::set<int>{1, 2}));
    EXPECT_NEAR(static_cast<double>(count) * image->spacing.prod() / 1000.0, c.volume_cc, 0.06);
    const Vec3 extent = (voxels.sizes() + Vec3::Ones()).cwiseProduct(image->spacing);
    EXPECT_LT((extent - c.extent).cwiseAbs().maxCoeff(), 0.1);
    EXPECT_NEAR(std::acos(std::min(1.0, std::abs(image->direction(2, 2)))) * 180.0 / M_PI, c.tilt_deg, 0.06);
    EXPECT_NEAR(image->direction.determinant(), 1.0, 1e-5);
    // The voxels are in RAS order: the first axis points to the right, which is -x in LPS.
    EXPECT_LT(image->direction(0, 0), -0.9);
    EXPECT_LT(image->direction(1, 1), -0.9);
  }
}

TEST_F(SharedData, eclipse_structure_set_survives_its_ten_empty_structures) {
  const auto input = read_input(data_folder() / "slicerrt_rando_rtstruct");  // the folder
  ASSERT_TRUE(input.ok()) << why(input);
  const ContourSet& set = std::get<ContourSet>(*input);
  const std::map<std::string, std::pair<std::size_t, double>> expected{
      {"BODY", {92, 10697.2}},         {"Bladder", {21, 117.5}}, {"Femoral Head Lt", {19, 49.4}},
      {"Femoral Head RT", {18, 50.3}}, {"PTV", {20, 49.2}},      {"Rectum", {40, 30.7}}};
  ASSERT_EQ(set.rois.size(), expected.size());
  for (const Roi& roi : set.rois) {
    ASSERT_TRUE(expected.contains(roi.name)) << roi.name;
    EXPECT_EQ(roi.contours.size(), expected.at(roi.name).first) << roi.name;
    EXPECT_NEAR(volume_cc(roi), expected.at(roi.name).second, 0.06) << roi.name;
    EXPECT_TRUE(structure_slices(roi, set.source).ok()) << why(structure_slices(roi, set.source));
  }
  EXPECT_EQ(set.passed_over.size(), 10U);
  EXPECT_EQ(set.frame_of_reference.substr(0, 8), "1.2.840.");
}

TEST_F(SharedData, vitesse_structure_set_gives_organs_and_notes_its_needles) {
  const auto set = value_of(read_rtstruct(data_folder() / "robustbrachy_hdr_phantom" / "SS001.dcm"));
  ASSERT_EQ(set.rois.size(), 3U);
  EXPECT_EQ(set.passed_over.size(), 14U);
  const std::map<std::string, double> expected{{"Prostate", 49.7}, {"Urethra", 1.4}, {"Rectum", 6.3}};
  for (const Roi& roi : set.rois) {
    EXPECT_NEAR(volume_cc(roi), expected.at(roi.name), 0.06) << roi.name;
    EXPECT_TRUE(structure_slices(roi, set.source).ok()) << why(structure_slices(roi, set.source));
  }
  // The folder also has a plan and a dose.
  EXPECT_TRUE(read_input(data_folder() / "robustbrachy_hdr_phantom").ok());
  expect_refused(read_input(data_folder() / "robustbrachy_hdr_phantom" / "PL001.dcm"), {"RTPLAN"});
  expect_refused(read_input(data_folder() / "robustbrachy_hdr_phantom" / "DO001.dcm"), {"RTDOSE"});
}

TEST_F(SharedData, real_structure_sets_survive_being_written_and_read) {
  const Folder folder;
  for (const char* name : {"slicerrt_rando_rtstruct", "robustbrachy_hdr_phantom"}) {
    const auto set = value_of(read_rtstruct(data_folder() / name));
    ASSERT_TRUE(write_rtstruct(set, folder / "copy.dcm").ok());
    ASSERT_TRUE(write_contour_json(set, folder / "copy.json").ok());
    const auto dicom = read_rtstruct(folder / "copy.dcm"), json = read_contour_json(folder / "copy.json");
    ASSERT_TRUE(dicom.ok() && json.ok()) << why(dicom) << why(json);
    EXPECT_LT(largest_difference(set, *dicom), 0.01);
    EXPECT_EQ(largest_difference(set, *json), 0.0);
    EXPECT_EQ(dicom->frame_of_reference, set.frame_of_reference);
  }
}

TEST_F(SharedData, third_party_meshes_load_with_their_scale_and_are_refused_without) {
  struct Case {
    const char* name;
    double scale;
    Index nodes, tets;
    double volume_units;
    std::size_t regions;
  };
  for (const Case& c : {Case{"tetmesh_thirdparty/liver.msh", 25.0, 181, 596, 36.561, 1},
                        Case{"tetmesh_thirdparty/liver2.msh", 100.0, 507, 1493, 1.1251, 1},
                        Case{"tetmesh_thirdparty/shark_22_ascii_fTetWild.msh", 1000.0, 425, 1070, 0.00011031, 1},
                        Case{"tetmesh_thirdparty/cube_41_ascii_vol_gmshApp.msh", 100.0, 14, 24, 1.0, 1},
                        Case{"tetmesh_thirdparty/teddy.vtk", 1000.0, 410, 1207, 0.2297, 1},
                        Case{"sphere_in_box/sphere_in_box_573.msh", 1000.0, 573, 2510, 0.00064, 2},
                        Case{"sphere_in_box/sphere_in_box_5037.msh", 1000.0, 5037, 26507, 0.00064, 2}}) {
    SCOPED_TRACE(c.name);
    expect_refused(read_tet_mesh(data_folder() / c.name), {c.name, "not in mm", "--scale"});
    const auto mesh = value_of(read_tet_mesh(data_folder() / c.name, {.scale = c.scale}));
    EXPECT_EQ(mesh.node_count(), c.nodes);
    EXPECT_EQ(mesh.tet_count(), c.tets);
    EXPECT_EQ(mesh.regions.size(), c.regions);
    double volume = 0.0;
    for (Index t = 0; t < mesh.tet_count(); ++t) volume += tet_volume(mesh, t);
    EXPECT_NEAR(volume / std::pow(c.scale, 3) / c.volume_units, 1.0, 1e-3);
  }
}

TEST_F(SharedData, a_triangulated_liver_is_a_surface) {
  const auto input = value_of(read_input(data_folder() / "tetmesh_thirdparty" / "liver-smooth.obj", {.scale = 25.0}));
  const auto& surfaces = std::get<std::vector<Surface>>(input);
  ASSERT_EQ(surfaces.size(), 1U);
  EXPECT_EQ(surfaces[0].points.size(), 2194U);
  EXPECT_EQ(surfaces[0].triangles.size(), 4384U);
}

TEST_F(SharedData, the_atlas_of_the_male_pelvis_loads_with_its_names_in_lps_mm) {
  std::map<std::string, Surface> organs;
  for (const auto& [file, count] : {std::pair("VH_M_Prostate.glb", 18U), std::pair("VH_M_Pelvis.glb", 14U),
                                    std::pair("VH_M_Urinary_Bladder.glb", 6U), std::pair("VH_M_Urethra.glb", 2U),
                                    std::pair("SBU_M_Intestine_Large.glb", 10U)}) {
    const auto surfaces = value_of(read_surfaces(data_folder() / "hubmap_vhm_pelvis" / file));
    EXPECT_EQ(surfaces.size(), count) << file;
    for (const Surface& s : surfaces) organs[s.name] = s;
  }
  const auto volume = [&](const std::string& name) {
    const Surface& s = organs.at(name);
    double six = 0.0;
    for (const auto& t : s.triangles) six += s.points[t[0]].cross(s.points[t[1]]).dot(s.points[t[2]]);
    return six / 6000.0;
  };
  EXPECT_NEAR(volume("VH_M_peripheral_zone_of_prostate_R"), 4.50, 0.01);
  EXPECT_NEAR(volume("VH_M_peripheral_zone_of_prostate_L"), 4.40, 0.01);
  EXPECT_NEAR(volume("VH_M_sacrum"), 243.0, 1.0);
  EXPECT_NEAR(volume("VH_M_pubis_compact_bone_L"), 15.8, 0.1);
  Eigen::AlignedBox3d pubis_left, rectum, sacrum;
  for (const Vec3& p : organs.at("VH_M_pubis_compact_bone_L").points) pubis_left.extend(p);
  for (const Vec3& p : organs.at("VH_M_rectum").points) rectum.extend(p);
  for (const Vec3& p : organs.at("VH_M_sacrum").points) sacrum.extend(p);
  EXPECT_GT(pubis_left.min().x(), 0.0) << "+x is the patient's left";
  EXPECT_GT(sacrum.center().y(), 50.0) << "+y is the back";
  EXPECT_NEAR(rectum.min().y(), 12.3, 0.1);
  EXPECT_NEAR(rectum.max().z(), 113.4, 0.1);
}

TEST_F(SharedData, files_that_are_no_input_are_refused_with_a_list) {
  for (const char* name :
       {"tetmesh_thirdparty/SOURCE.md", "force_okamura_insertion/depth_force.csv", "tg43_i125_6711/brachy_LDR.mat"}) {
    expect_refused(read_input(data_folder() / name), {"not recognised", "Stylet reads"});
  }
  expect_refused(read_input(data_folder() / "msd_prostate_masks/dataset.json"), {"stylet-contours"});
}
