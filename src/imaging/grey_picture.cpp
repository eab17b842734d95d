// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/grey_picture.hpp"

#include <Eigen/Geometry>

namespace stylet {

Eigen::Matrix4d GreyPicture::pixel_to_lps() const {
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  transform.block<3, 1>(0, 0) = mm_per_pixel * right;
  transform.block<3, 1>(0, 1) = mm_per_pixel * down;
  transform.block<3, 1>(0, 2) = right.cross(down);
  transform.block<3, 1>(0, 3) = corner_mm;
  return transform;
}

}  // namespace stylet
