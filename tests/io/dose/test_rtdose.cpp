// SPDX-License-Identifier: GPL-3.0-or-later
// Dose grids in DICOM RTDOSE, with the oddities of real files.
#include "io/dose/dose_folder.hpp"
#include "io/dose/rtplan_files.hpp"
#include "stylet/io/dose_io.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <cstdlib>
#include <random>

namespace stylet {
namespace {

namespace fs = std::filesystem;
using testing_files::put;

/// An RT Dose of 4 × 3 × 3 points whose stored number at (i, j, frame) is 1 + i + 10 j + 100 frame.
struct RtdoseFile {
  DcmFileFormat file;
  explicit RtdoseFile(int bits = 16, const std::string& offsets = "0\\2\\4") {
    DcmDataset& data = *file.getDataset();
    put(data, DCM_SOPClassUID, UID_RTDoseStorage);
    put(data, DCM_SOPInstanceUID, "1.2.3.9");
    put(data, DCM_Modality, "RTDOSE");
    put(data, DCM_FrameOfReferenceUID, "1.2.3");
    put(data, DCM_ImagePositionPatient, "-10\\20\\5");
    put(data, DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
    put(data, DCM_PixelSpacing, "3\\1.5");
    put(data, DCM_NumberOfFrames, "3");
    put(data, DCM_GridFrameOffsetVector, offsets);
    put(data, DCM_DoseUnits, "GY");
    put(data, DCM_DoseSummationType, "PLAN");
    put(data, DCM_DoseGridScaling, "0.5");
    data.putAndInsertUint16(DCM_Rows, 3);
    data.putAndInsertUint16(DCM_Columns, 4);
    data.putAndInsertUint16(DCM_BitsAllocated, static_cast<Uint16>(bits));
    data.putAndInsertUint16(DCM_BitsStored, static_cast<Uint16>(bits));
    data.putAndInsertUint16(DCM_PixelRepresentation, 0);
    std::vector<Uint16> words;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) {
          words.push_back(static_cast<Uint16>(1 + i + 10 * j + 100 * k));
          if (bits == 32) words.push_back(1);  // 65536 more
        }
      }
    }
    data.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size()));
  }
};

class Rtdose : public testing_files::InFolder {
 protected:
  [[nodiscard]] Result<DoseGrid> read(RtdoseFile& dose) const {
    dose.file.saveFile((folder / "dose.dcm").c_str(), EXS_LittleEndianExplicit);
    return read_rtdose(folder / "dose.dcm");
  }
  void expect_error(RtdoseFile& dose, const std::string& part) const {
    testing_files::expect_refused(read(dose), part);
  }
};

TEST_F(Rtdose, has_its_doses_at_the_places_that_the_header_says) {
  for (const int bits : {16, 32}) {
    RtdoseFile dose(bits);
    const DoseGrid grid = read(dose).value();
    EXPECT_EQ(grid.size, (std::array<Index, 3>{4, 3, 3}));
    const double more = bits == 32 ? 65536.0 : 0.0;
    // Columns are 1.5 mm apart, rows 3 mm, frames 2 mm.
    EXPECT_NEAR(grid.at(Vec3(-10 + 1.5, 20 + 6, 5 + 4)), 0.5 * (1 + 1 + 20 + 200 + more), 1e-2);
    EXPECT_NEAR(grid.at(Vec3(-10, 20, 5)), 0.5 * (1 + more), 1e-2);
    EXPECT_FALSE(grid.covers(Vec3(-10, 20, 4.9)));
  }
}

TEST_F(Rtdose, has_the_same_doses_in_big_endian_with_every_order_of_its_halves) {
  for (const int bits : {16, 32}) {
    for (const bool halves_turned : {true, false}) {
      if (bits == 16 && halves_turned) continue;
      RtdoseFile dose(bits);
      DcmDataset& data = *dose.file.getDataset();
      std::vector<Uint16> words;  // DCMTK turns the bytes of each word, so the test turns the words
      for (int p = 0; p < 36; ++p) {
        const int number = 1 + p % 4 + 10 * (p / 4 % 3) + 100 * (p / 12);
        if (bits == 16) {
          words.push_back(static_cast<Uint16>(number));
          continue;
        }
        words.push_back(halves_turned ? Uint16{1} : static_cast<Uint16>(number));
        words.push_back(halves_turned ? static_cast<Uint16>(number) : Uint16{1});
      }
      data.putAndInsertUint16Array(DCM_PixelData, words.data(), static_cast<unsigned long>(words.size()));
      ASSERT_TRUE(dose.file.saveFile((folder / "big.dcm").c_str(), EXS_BigEndianExplicit).good());
      const DoseGrid grid = read_rtdose(folder / "big.dcm").value();
      const double more = bits == 32 ? 65536.0 : 0.0;
      EXPECT_NEAR(grid.at(Vec3(-10, 20, 5)), 0.5 * (1 + more), 1e-2) << bits << halves_turned;
      EXPECT_NEAR(grid.at(Vec3(-10 + 1.5, 20 + 6, 5 + 4)), 0.5 * (222 + more), 1e-2) << bits << halves_turned;
      EXPECT_EQ(grid.notes.size(), bits == 32 && !halves_turned ? 1U : 0U);
    }
  }
}

TEST_F(Rtdose, may_count_its_frames_downwards_or_give_their_own_z) {
  RtdoseFile down(16, "-0\\-2\\-4");
  const DoseGrid falling = read(down).value();
  EXPECT_NEAR(falling.at(Vec3(-10, 20, 5)), 0.5, 1e-6);
  EXPECT_NEAR(falling.at(Vec3(-10, 20, 1)), 0.5 * 201, 1e-6);
  EXPECT_GT(falling.direction.determinant(), 0.0);
  EXPECT_GT(falling.spacing_mm.z(), 0.0);
  RtdoseFile absolute(16, "5\\7\\9");
  EXPECT_NEAR(read(absolute).value().at(Vec3(-10, 20, 9)), 0.5 * 201, 1e-6);
}

TEST_F(Rtdose, in_cGy_is_converted_and_a_relative_one_is_refused) {
  RtdoseFile small;
  put(*small.file.getDataset(), DCM_DoseUnits, "CGY");
  EXPECT_NEAR(read(small).value().at(Vec3(-10, 20, 5)), 0.005, 1e-8);
  RtdoseFile relative;
  put(*relative.file.getDataset(), DCM_DoseUnits, "RELATIVE");
  expect_error(relative, "RELATIVE");
}

TEST_F(Rtdose, says_that_doses_reach_the_largest_number_and_that_a_frame_is_empty) {
  RtdoseFile dose;
  std::vector<Uint16> words(36, 0);
  words[3] = 65535;
  words[30] = 7;
  dose.file.getDataset()->putAndInsertUint16Array(DCM_PixelData, words.data(), 36);
  const DoseGrid grid = read(dose).value();
  EXPECT_NEAR(grid.largest_Gy, 0.5 * 65535, 1e-6);
  EXPECT_NEAR(grid.quantum_Gy, 0.5, 1e-12);
  ASSERT_EQ(grid.notes.size(), 2U);
  EXPECT_NE(grid.notes[1].find("Frame 2"), std::string::npos) << grid.notes[1];
}

TEST_F(Rtdose, with_a_damaged_header_is_refused_in_words) {
  RtdoseFile unequal(16, "0\\2\\7");
  expect_error(unequal, "frames");
  RtdoseFile few(16, "0\\2");
  expect_error(few, "3 frames");
  RtdoseFile unscaled;
  put(*unscaled.file.getDataset(), DCM_DoseGridScaling, "0");
  expect_error(unscaled, "DoseGridScaling");
  RtdoseFile many;
  put(*many.file.getDataset(), DCM_NumberOfFrames, "4");
  put(*many.file.getDataset(), DCM_GridFrameOffsetVector, "0\\2\\4\\6");
  expect_error(many, "announces 48 doses");
  RtdoseFile skew;
  put(*skew.file.getDataset(), DCM_ImageOrientationPatient, "1\\0\\0\\1\\1\\0");
  expect_error(skew, "perpendicular");
  RtdoseFile plan;
  put(*plan.file.getDataset(), DCM_Modality, "RTPLAN");
  put(*plan.file.getDataset(), DCM_SOPClassUID, UID_RTPlanStorage);
  expect_error(plan, "RTDOSE is expected");
}

TEST_F(Rtdose, that_is_written_is_read_again_with_the_same_doses) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> dose(0.0F, 700.0F);
  for (int round = 0; round < 5; ++round) {
    DoseGrid grid;
    grid.size = {7, 5, 4};
    grid.origin_mm = Vec3(-12.25, 3.5, 88.125);
    grid.spacing_mm = Vec3(1.0, 1.25, 2.5);
    grid.frame_of_reference = "1.2.3.4";
    if (round % 2 == 1) grid.direction = Eigen::AngleAxisd(0.3 * round, Vec3(1, -1, 2).normalized()).toRotationMatrix();
    grid.dose_Gy.resize(grid.count());
    for (float& d : grid.dose_Gy) d = dose(random);
    ASSERT_TRUE(write_rtdose(grid, "1.2.3.5", folder / "dose.dcm").ok());
    const DoseGrid back = read_rtdose(folder / "dose.dcm").value();
    ASSERT_EQ(back.size, grid.size);
    EXPECT_LT((back.point(6, 4, 3) - grid.point(6, 4, 3)).norm(), 1e-6);
    EXPECT_EQ(back.frame_of_reference, "1.2.3.4");
    for (std::size_t p = 0; p < grid.dose_Gy.size(); ++p) EXPECT_NEAR(back.dose_Gy[p], grid.dose_Gy[p], 1e-4);
    ASSERT_TRUE(write_dose_nrrd(grid, folder / "dose.nrrd").ok());
    EXPECT_GT(fs::file_size(folder / "dose.nrrd"), 400U);
  }
}

TEST_F(Rtdose, that_is_written_is_read_by_the_tools_of_dcmtk) {
  if (std::system("command -v drtdump > /dev/null 2>&1") != 0) GTEST_SKIP() << "drtdump (Debian: dcmtk) is not there";
  DoseGrid grid;
  grid.size = {3, 3, 3};
  grid.dose_Gy.assign(27, 12.5F);
  const fs::path path = folder / "dose.dcm";
  ASSERT_TRUE(write_rtdose(grid, "", path).ok());
  const std::string log = (folder / "log.txt").string();
  EXPECT_EQ(std::system(("drtdump " + path.string() + " > " + log + " 2>&1").c_str()), 0);
  std::ifstream text(log);
  for (std::string line; std::getline(text, line);) {
    EXPECT_FALSE(line.starts_with("E:") || line.starts_with("W:")) << line;
  }
  EXPECT_FALSE(write_rtdose(grid, "", folder / "absent" / "dose.dcm").ok());
  grid.dose_Gy[4] = NAN;
  EXPECT_FALSE(write_rtdose(grid, "", path).ok());
}

}  // namespace
}  // namespace stylet
