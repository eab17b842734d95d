// SPDX-License-Identifier: GPL-3.0-or-later
#include "made_anatomy.hpp"
#include "mesh_checks.hpp"

#include <limits>

namespace stylet {
namespace {

using testing::gland;
using testing::set_of;

/// The result is an input error whose message contains all parts.
template <class Input>
void expect_refused(const Result<Input>& r, const std::vector<std::string>& parts) {
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().kind, ErrorKind::input);
  EXPECT_FALSE(r.error().cure.empty());
  for (const std::string& part : parts) {
    EXPECT_NE(r.error().message().find(part), std::string::npos) << r.error().message();
  }
}

TEST(MesherRefuses, a_set_without_structures) { expect_refused(mesh_contours(set_of({}), {}), {"no structures"}); }

TEST(MesherRefuses, a_set_without_target_and_lists_the_names_found) {
  expect_refused(mesh_contours(set_of({gland("Bladder"), gland("Lesion X")}), {}), {"Bladder", "Lesion X", "target"});
}

TEST(MesherRefuses, empty_targets) {
  Roi empty;
  empty.name = "Prostate";
  expect_refused(mesh_contours(set_of({empty}), {}), {"Prostate (empty)"});
}

TEST(MesherRefuses, a_structure_on_one_slice) {
  Roi flat;
  flat.name = "Prostate";
  flat.contours = {testing::circle(Vec3::Zero(), 20)};
  expect_refused(mesh_contours(set_of({flat}), {}), {"'Prostate'", "one slice only"});
}

TEST(MesherRefuses, a_roi_name_that_is_not_there) {
  MeshOptions o;
  o.regions = {{"Prostat", "prostate"}};
  expect_refused(mesh_contours(set_of({gland()}), o), {"Prostat", "Prostate"});
}

TEST(MesherRefuses, points_that_are_not_numbers) {
  Roi bad = gland();
  bad.contours[3].points[5].x() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(mesh_contours(set_of({bad}), {}), {"'Prostate'", "finite"});
}

TEST(MesherRefuses, contours_that_are_not_parallel) {
  Roi bad = gland();
  for (Vec3& p : bad.contours[4].points) p.z() += 0.2 * p.x();
  expect_refused(mesh_contours(set_of({bad}), {}), {"'Prostate'", "parallel"});
}

TEST(MesherRefuses, fewer_nodes_than_the_anatomy_needs_and_says_how_many_it_needs) {
  MeshOptions o;
  o.nodes = 30;
  expect_refused(mesh_contours(set_of({gland()}), o), {"30 nodes are wanted", "needs about"});
}

TEST(MesherRefuses, an_absurd_number_of_nodes) {
  MeshOptions o;
  o.nodes = 100000000;
  expect_refused(mesh_contours(set_of({gland()}), o), {"number of nodes"});
  o.nodes = -5;
  expect_refused(mesh_contours(set_of({gland()}), o), {"number of nodes"});
}

TEST(MesherRefuses, a_structure_that_others_cover_completely) {
  MeshOptions o;
  o.nodes = 600;
  const auto r = mesh_contours(set_of({gland(), testing::ellipsoid("Rectum", Vec3(5, -20, 10), Vec3(8, 8, 8), 3)}), o);
  expect_refused(r, {"'rectum'", "outside other structures"});
}

TEST(MesherRefuses, a_mask_of_background) {
  LabelImage image = testing::two_zones();
  std::fill(image.labels.begin(), image.labels.end(), std::uint16_t{0});
  expect_refused(mesh_labels(image, {}), {"background"});
}

TEST(MesherRefuses, a_mask_of_one_slice) {
  LabelImage image = testing::two_zones();
  for (std::size_t n = 0; n < image.labels.size(); ++n) {
    if (n / (64 * 56) != 7) image.labels[n] = 0;
  }
  expect_refused(mesh_labels(image, {}), {"one slice"});
}

TEST(MesherRefuses, a_label_that_is_not_there) {
  MeshOptions o;
  o.regions = {{"7", "prostate"}};
  expect_refused(mesh_labels(testing::two_zones(), o), {"'7'", "1", "2"});
}

TEST(MesherRefuses, a_mask_without_target_among_the_names_given) {
  MeshOptions o;
  o.regions = {{"1", "bladder"}};
  expect_refused(mesh_labels(testing::two_zones(), o), {"target"});
}

TEST(MesherRefuses, an_image_whose_labels_do_not_fill_it) {
  LabelImage image = testing::two_zones();
  image.labels.pop_back();
  expect_refused(mesh_labels(image, {}), {"labels for"});
}

}  // namespace
}  // namespace stylet
