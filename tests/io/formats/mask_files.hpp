// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/io/label_image_io.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stylet::test {

/// A small mask in a freely chosen frame, which the functions below write in three formats.
struct Mask {
  std::array<int, 3> size{12, 10, 8};
  Mat3 axes = Vec3(2.0, 2.5, 4.0).asDiagonal();  ///< [mm] LPS, columns: voxel steps
  Vec3 origin{-10.0, 20.0, -30.0};               ///< [mm] LPS
  std::vector<std::uint8_t> labels;

  Mask();  ///< label 1 in a box of 6 × 4 × 3 voxels from (2,3,2), label 2 in voxel (9,7,5)
  [[nodiscard]] Vec3 centre(int label) const;  ///< [mm] LPS, mean of the label's voxel centres
};

/// An oblique right-handed frame, and its mirror image.
Mat3 oblique_axes();
Mat3 left_handed_axes();

std::string gzipped(const std::string& bytes);

enum class NiftiForm { sform, qform, none };
/// NIfTI-1 single file. The qform can hold rotations only: right-handed, or left-handed by qfac.
std::string nifti(const Mask& mask, NiftiForm form = NiftiForm::sform);
/// Overwrites a number in the header.
template <class T>
void poke(std::string& bytes, std::size_t offset, T value) {
  bytes.replace(offset, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

/// The mask as NIfTI, with values of another type. @param code of the type in the header
template <class T>
std::string with_values(std::int16_t code, const std::function<double(int)>& value) {
  const Mask mask;
  std::string bytes = nifti(mask).substr(0, 352);
  poke<std::int16_t>(bytes, 70, code);
  poke<std::int16_t>(bytes, 72, 8 * sizeof(T));
  for (const int label : mask.labels) {
    const T v = static_cast<T>(value(label));
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  return bytes;
}

inline constexpr std::int16_t nifti_i16 = 4, nifti_f32 = 16, nifti_f64 = 64;

/// NRRD header and data, LPS; `extra` are further header lines.
std::string nrrd(const Mask& mask, const std::string& encoding = "raw", const std::string& extra = "",
                 const std::string& space = "left-posterior-superior");
std::string metaimage(const Mask& mask, bool compressed = false, const std::string& data_file = "LOCAL");

/// Reads a file with this name and content.
Result<LabelImage> read_mask(const std::string& name, const std::string& bytes);

}  // namespace stylet::test
