// SPDX-License-Identifier: GPL-3.0-or-later
#include "planar.hpp"
#include "stylet/geom/structure_slices.hpp"
#include "stylet/io/contours_io.hpp"
#include "stylet/phantom/phantom.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <map>

using namespace stylet;
using namespace stylet::test;

namespace {

const Roi& roi(const ContourSet& set, const std::string& name) {
  const auto found = std::find_if(set.rois.begin(), set.rois.end(), [&](const Roi& r) { return r.name == name; });
  if (found == set.rois.end()) throw std::runtime_error("no structure " + name);
  return *found;
}

const ContourSet& reference() {
  static const ContourSet set = demo_patient();
  return set;
}

/// The reference patient drawn every millimetre, to measure volumes and distances between the usual slices.
const ContourSet& fine_reference() {
  static const ContourSet set = demo_patient({.seed = 0, .slice_spacing_mm = 1.0});
  return set;
}

const Contour& slice(const Roi& structure, double z) {
  return *std::min_element(
      structure.contours.begin(), structure.contours.end(),
      [&](const Contour& a, const Contour& b) { return std::abs(height(a) - z) < std::abs(height(b) - z); });
}

Eigen::Vector2d extent(const Contour& c) {
  Eigen::AlignedBox3d b;
  for (const Vec3& p : c.points) b.extend(p);
  return b.sizes().head<2>();
}

}  // namespace

TEST(Phantom, has_the_seven_structures_on_slices_5_mm_apart) {
  std::vector<std::string> names;
  for (const Roi& r : reference().rois) {
    names.push_back(r.name);
    for (const Contour& c : r.contours) {
      EXPECT_DOUBLE_EQ(height(c) / 5.0, std::round(height(c) / 5.0)) << r.name;
      for (const Vec3& p : c.points) EXPECT_EQ(p.z(), height(c)) << r.name;
      EXPECT_GT(area_mm2(c), 0.0) << r.name << " runs clockwise";
    }
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"Prostate", "Urethra", "Bladder", "Rectum", "Pubic arch", "Band", "Body"}));
  EXPECT_EQ(roi(reference(), "Body").type, "EXTERNAL");
}

TEST(Phantom, reference_prostate_has_published_volume_and_size) {
  const Roi& prostate = roi(fine_reference(), "Prostate");
  EXPECT_NEAR(volume_cc(prostate, 1.0), 40.0, 0.5);
  EXPECT_NEAR(volume_cc(roi(reference(), "Prostate"), 5.0), 40.0, 1.5);
  const Vec3 size = box(prostate).sizes();
  EXPECT_GT(size.x(), 44.0);
  EXPECT_LT(size.x(), 50.0);
  EXPECT_GT(size.y(), 30.0);
  EXPECT_LT(size.y(), 36.0);
  EXPECT_GT(size.z(), 39.0);
  EXPECT_LT(size.z(), 46.0);
}

TEST(Phantom, prostate_is_hollow_behind_and_its_apex_is_narrower_than_its_base) {
  const Roi& prostate = roi(reference(), "Prostate");
  const Contour& middle = slice(prostate, 0.0);
  double midline = 0.0, lobes = 0.0;
  for (const Vec3& p : middle.points) {
    (std::abs(p.x()) < 3.0 ? midline : lobes) = std::max(std::abs(p.x()) < 3.0 ? midline : lobes, p.y());
  }
  EXPECT_GT(lobes - midline, 0.5);
  EXPECT_LT(lobes - midline, 4.0);
  EXPECT_LT(extent(slice(prostate, -20.0)).x(), 0.85 * extent(slice(prostate, 20.0)).x());
  EXPECT_LT(extent(slice(prostate, -15.0)).x(), 0.9 * extent(slice(prostate, 15.0)).x());
}

TEST(Phantom, urethra_is_6_to_7_mm_wide_and_bends_forward_below_the_middle_of_the_gland) {
  const Roi& urethra = roi(fine_reference(), "Urethra");
  std::map<double, double> centre;
  for (const Contour& c : urethra.contours) {
    const double diameter = std::sqrt(4.0 * area_mm2(c) / M_PI);
    EXPECT_GT(diameter, 6.0);
    EXPECT_LT(diameter, 7.0);
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : c.points) mean += p / static_cast<double>(c.points.size());
    centre[height(c)] = mean.y();
  }
  EXPECT_GT(centre.at(-2.0), centre.at(20.0) + 3.0);
  EXPECT_GT(centre.at(-2.0), centre.at(-20.0) + 2.0);
  EXPECT_LT(centre.begin()->second, centre.at(-20.0) - 3.0);
  EXPECT_LT(centre.begin()->first, box(roi(fine_reference(), "Prostate")).min().z() - 10.0);
}

TEST(Phantom, bladder_rectum_and_skin_have_published_dimensions) {
  EXPECT_NEAR(volume_cc(roi(fine_reference(), "Bladder"), 1.0), 120.0, 3.0);
  const Roi& prostate = roi(fine_reference(), "Prostate");
  EXPECT_GE(box(roi(fine_reference(), "Bladder")).min().z(), box(prostate).max().z());
  for (const Contour& c : roi(reference(), "Rectum").contours) {
    if (height(c) < -20.0) continue;  // the anal canal is narrower
    EXPECT_GT(extent(c).mean(), 25.0) << "z = " << height(c);
    EXPECT_LT(extent(c).mean(), 36.0) << "z = " << height(c);
  }
  const Roi& body = roi(fine_reference(), "Body");
  const double depth = box(prostate).min().z() - box(body).min().z();
  EXPECT_GT(depth, 25.0);
  EXPECT_LT(depth, 35.0);
  const Vec3 size = box(body).sizes();
  EXPECT_TRUE(size.x() > 150 && size.x() < 185 && size.y() > 130 && size.y() < 155 && size.z() > 125 && size.z() < 155)
      << size.transpose();
}

TEST(Phantom, perineum_is_rounded) {
  double last = 0.0;
  int shrinking = 0;
  for (const Contour& c : roi(reference(), "Body").contours) {
    if (height(c) > -20.0) break;
    EXPECT_GT(area_mm2(c), last) << "z = " << height(c);
    last = area_mm2(c);
    ++shrinking;
  }
  EXPECT_GE(shrinking, 5);
}

TEST(Phantom, written_as_dicom_or_json_it_comes_back_to_a_hundredth_of_a_millimetre) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("stylet-phantom-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  ASSERT_TRUE(write_rtstruct(reference(), folder / "case.dcm").ok());
  ASSERT_TRUE(write_contour_json(reference(), folder / "case.json").ok());
  const Result<ContourSet> dicom = read_rtstruct(folder / "case.dcm"), json = read_contour_json(folder / "case.json");
  std::filesystem::remove_all(folder);
  for (const Result<ContourSet>* back : {&dicom, &json}) {
    ASSERT_TRUE(back->ok()) << back->error().message();
    ASSERT_EQ((*back)->rois.size(), reference().rois.size());
    for (std::size_t r = 0; r < reference().rois.size(); ++r) {
      const Roi &a = reference().rois[r], &b = (*back)->rois[r];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.type, b.type);
      EXPECT_EQ(a.colour, b.colour);
      ASSERT_EQ(a.contours.size(), b.contours.size());
      for (std::size_t c = 0; c < a.contours.size(); ++c) {
        ASSERT_EQ(a.contours[c].points.size(), b.contours[c].points.size());
        for (std::size_t i = 0; i < a.contours[c].points.size(); ++i) {
          EXPECT_LT((a.contours[c].points[i] - b.contours[c].points[i]).norm(), 0.01);
        }
      }
    }
  }
}

TEST(Phantom, same_seed_gives_the_same_patient_and_another_seed_another) {
  const ContourSet a = demo_patient({.seed = 3}), b = demo_patient({.seed = 3}), c = demo_patient({.seed = 4});
  ASSERT_EQ(a.rois.size(), b.rois.size());
  for (std::size_t i = 0; i < a.rois.size(); ++i) {
    ASSERT_EQ(a.rois[i].contours.size(), b.rois[i].contours.size());
    for (std::size_t k = 0; k < a.rois[i].contours.size(); ++k) {
      EXPECT_EQ(a.rois[i].contours[k].points, b.rois[i].contours[k].points);
    }
  }
  EXPECT_NE(a.rois[0].contours[3].points, c.rois[0].contours[3].points);
}

TEST(Phantom, seeds_spread_the_gland_over_30_to_60_cc) {
  std::vector<double> volumes;
  for (std::uint64_t seed = 0; seed <= 50; ++seed) {
    const ContourSet set = demo_patient({.seed = seed, .slice_spacing_mm = 2.0});
    volumes.push_back(volume_cc(roi(set, "Prostate"), 2.0));
    EXPECT_GT(volumes.back(), 30.0) << "seed " << seed;
    EXPECT_LT(volumes.back(), 60.0) << "seed " << seed;
    const double bladder = volume_cc(roi(set, "Bladder"), 2.0);
    EXPECT_GT(bladder, 100.0) << "seed " << seed;
    EXPECT_LT(bladder, 150.0) << "seed " << seed;
  }
  const auto [low, high] = std::minmax_element(volumes.begin(), volumes.end());
  EXPECT_LT(*low, 38.0);
  EXPECT_GT(*high, 50.0);
}

namespace {

constexpr std::uint64_t last_seed = 50;

/// Calls `judge` for every patient, drawn every 2.5 mm; failures name the seed.
void for_every_seed(const std::function<void(const ContourSet&)>& judge) {
  static const std::vector<ContourSet> patients = [] {
    std::vector<ContourSet> all;
    for (std::uint64_t seed = 0; seed <= last_seed; ++seed)
      all.push_back(demo_patient({.seed = seed, .slice_spacing_mm = 2.5}));
    return all;
  }();
  for (const ContourSet& set : patients) {
    SCOPED_TRACE(set.label);
    judge(set);
  }
}

}  // namespace

TEST(PhantomSeeds, every_structure_is_a_valid_region_of_interest) {
  for (std::uint64_t seed = 0; seed <= last_seed; ++seed) {
    for (const double spacing : {2.5, 5.0, 8.0}) {
      const ContourSet set = demo_patient({.seed = seed, .slice_spacing_mm = spacing});
      for (const Roi& r : set.rois) {
        const auto checked = structure_slices(r, set.label);
        EXPECT_TRUE(checked.ok()) << (checked.ok() ? "" : checked.error().message()) << " spacing " << spacing;
      }
    }
  }
}

TEST(PhantomSeeds, organs_keep_their_distance) {
  for_every_seed([](const ContourSet& set) {
    const Roi &prostate = roi(set, "Prostate"), &urethra = roi(set, "Urethra"), &bladder = roi(set, "Bladder"),
              &rectum = roi(set, "Rectum"), &arch = roi(set, "Pubic arch"), &band = roi(set, "Band");
    const double behind = clearance(prostate, rectum);
    EXPECT_GE(behind, 2.0);
    EXPECT_LE(behind, 8.0);
    EXPECT_GE(clearance(prostate, arch), 3.5);
    EXPECT_LE(clearance(prostate, arch), 13.0);
    EXPECT_GE(clearance(bladder, arch), 2.0);
    EXPECT_GE(clearance(bladder, rectum), 3.0);
    EXPECT_GE(clearance(urethra, rectum), 8.0);
    EXPECT_GE(clearance(urethra, arch), 5.0);
    EXPECT_GE(clearance(rectum, arch), 10.0);
    EXPECT_GE(clearance(band, urethra), 1.0);
    EXPECT_GT(clearance(prostate, bladder), 1e6) << "they meet at the bladder neck, but share no slice";
  });
}

TEST(PhantomSeeds, urethra_lies_inside_the_gland_where_there_is_gland) {
  for_every_seed([](const ContourSet& set) {
    for (const Contour& u : roi(set, "Urethra").contours) {
      for (const Contour& g : roi(set, "Prostate").contours) {
        if (height(u) != height(g)) continue;
        EXPECT_TRUE(std::all_of(u.points.begin(), u.points.end(), [&](const Vec3& p) { return inside(g, p); }));
        EXPECT_GT(gap(u, g), 1.0) << "z = " << height(u);
      }
    }
  });
}

TEST(PhantomSeeds, everything_lies_inside_the_body) {
  for_every_seed([](const ContourSet& set) {
    std::map<double, const Contour*> skin;
    for (const Contour& c : roi(set, "Body").contours) skin[height(c)] = &c;
    for (const Roi& r : set.rois) {
      if (r.name == "Body") continue;
      for (const Contour& c : r.contours) {
        ASSERT_TRUE(skin.contains(height(c))) << r.name << " reaches beyond the body";
        const Contour& outside = *skin.at(height(c));
        EXPECT_TRUE(std::all_of(c.points.begin(), c.points.end(), [&](const Vec3& p) { return inside(outside, p); }))
            << r.name << " z = " << height(c);
        EXPECT_GT(gap(c, outside), 4.0) << r.name << " z = " << height(c);
      }
    }
  });
}

TEST(PhantomSeeds, band_ties_the_gland_to_the_arch) {
  for_every_seed([](const ContourSet& set) {
    const Roi& band = roi(set, "Band");
    EXPECT_EQ(clearance(band, roi(set, "Prostate")), -1.0);
    EXPECT_EQ(clearance(band, roi(set, "Pubic arch")), -1.0);
    EXPECT_LT(box(band).center().z(), 0.0) << "inferior";
    EXPECT_LT(box(band).center().y(), box(roi(set, "Prostate")).center().y()) << "anterior";
  });
}

TEST(PhantomSeeds, straight_needles_reach_most_of_the_gland_past_the_arch) {
  for_every_seed([](const ContourSet& set) {
    const Roi &prostate = roi(set, "Prostate"), &arch = roi(set, "Pubic arch");
    int total = 0, blocked = 0;
    for (const Contour& g : prostate.contours) {
      Eigen::AlignedBox3d b;
      for (const Vec3& p : g.points) b.extend(p);
      for (double x = b.min().x(); x < b.max().x(); x += 2.5) {
        for (double y = b.min().y(); y < b.max().y(); y += 2.5) {
          const Vec3 target(x, y, height(g));
          if (!inside(g, target)) continue;
          ++total;
          blocked += std::any_of(arch.contours.begin(), arch.contours.end(),
                                 [&](const Contour& a) { return height(a) <= height(g) && inside(a, target); });
        }
      }
    }
    ASSERT_GT(total, 300);
    EXPECT_LT(blocked, 0.08 * total);
  });
}
