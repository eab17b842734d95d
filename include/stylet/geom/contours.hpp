// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet {

/// One closed polygon in one plane.
struct Contour {
  std::vector<Vec3> points;  ///< [mm] LPS, in order, first point not repeated at the end
};

/// A structure ("region of interest"): its contours on parallel slices.
struct Roi {
  std::string name;                          ///< as in the file
  int number = 0;                            ///< ROI number of the file
  std::string type;                          ///< RT ROI interpreted type ("ORGAN", "EXTERNAL", …) or empty
  std::array<int, 3> colour{255, 255, 255};  ///< display colour, 0…255
  std::vector<Contour> contours;
};

/// A structure of the file that has no closed contour to offer.
struct PassedOver {
  std::string name;
  std::string why;  ///< a few words: "empty", "only open curves or points"
};

/// Contours of one patient on parallel slices, all in one frame of reference.
struct ContourSet {
  std::string source;              ///< file it was read from
  std::string label;               ///< structure set label
  std::string frame_of_reference;  ///< DICOM frame of reference UID, may be empty
  std::vector<Roi> rois;
  std::vector<PassedOver> passed_over;  ///< structures of the file that are not among `rois`
  std::vector<std::string> notes;       ///< what the reader left out of a structure, in words for the user
};

}  // namespace stylet
