// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of MetaImage with MetaIO, the format's own library, part of VTK.
#include "detail/whole_file.hpp"
#include "stylet/io/picture_io.hpp"

#include <fmt/format.h>
#include <vtkmetaio/metaImage.h>
#include <Eigen/Geometry>

#include <array>

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
  return detail::write_whole(path, [&](const std::filesystem::path& temporary) -> Result<> {
    // MetaIO chooses the kind of the file by its ending.
    const std::filesystem::path named = temporary.string() + ".mha";
    std::error_code code;
    if (!image.Write(named.c_str())) {
      std::filesystem::remove(named, code);
      return failure(path.string(), "cannot be written", "Check the folder and the free space on its disk");
    }
    std::filesystem::rename(named, temporary, code);
    if (code) return failure(path.string(), "cannot be written: " + code.message(), "Check the folder");
    return Ok{};
  });
}

}  // namespace stylet
