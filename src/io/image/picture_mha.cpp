// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of MetaImage with MetaIO, the format's own library, part of VTK.
#include "stylet/io/files.hpp"
#include "stylet/io/picture_io.hpp"

#include <fmt/format.h>
#include <vtkmetaio/metaImage.h>
#include <Eigen/Geometry>

#include <array>
#include <fstream>
#include <sstream>

namespace stylet {

Result<> write_picture_mha(std::span<const GreyPicture> pictures, double distance_mm,
                           const std::filesystem::path& path) {
  if (pictures.empty()) return failure(path.string(), "there is no picture to be written", "Give one");
  const GreyPicture& first = pictures.front();
  std::vector<std::uint8_t> voxels;
  for (const GreyPicture& picture : pictures) {
    if (picture.columns != first.columns || picture.rows != first.rows || !picture.right.isApprox(first.right) ||
        !picture.down.isApprox(first.down))
      return failure(path.string(), "the pictures differ in size or orientation", "Write a file for each of them");
    voxels.insert(voxels.end(), picture.pixels.begin(), picture.pixels.end());
  }
  vtkmetaio::MetaImage image(first.columns, first.rows, static_cast<int>(pictures.size()),
                             static_cast<float>(first.mm_per_pixel), static_cast<float>(first.mm_per_pixel),
                             static_cast<float>(distance_mm), vtkmetaio::MET_UCHAR, 1, voxels.data());
  const Vec3 normal = first.right.cross(first.down);
  std::array<double, 9> axes{};
  for (Eigen::Index k = 0; k < 3; ++k) {
    axes[static_cast<std::size_t>(k)] = first.right[k];
    axes[static_cast<std::size_t>(3 + k)] = first.down[k];
    axes[static_cast<std::size_t>(6 + k)] = normal[k];
  }
  const std::array<double, 3> spacing{first.mm_per_pixel, first.mm_per_pixel, distance_mm};
  image.ElementSpacing(spacing.data());
  image.TransformMatrix(axes.data());
  image.Offset(first.corner_mm.data());
  image.BinaryData(true);
  image.CompressedData(true);
  image.Comment("simulated; not a medical device");
  image.ElementDataFileName("LOCAL");  // in the same file
  std::stringbuf bytes;
  std::ofstream stream;  // the kind of stream that MetaIO takes
  static_cast<std::ios&>(stream).rdbuf(&bytes);
  if (!image.WriteStream(&stream) || !stream)
    return failure(path.string(), "MetaIO cannot make the file", "Write a .png file instead");
  return write_whole_file(path, bytes.str());
}

}  // namespace stylet
