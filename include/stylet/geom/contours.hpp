// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>
#include <string>
#include <vector>

namespace stylet {

/// One closed polygon in one plane.
struct Contour {
  std::vector<Vec3> points;  ///< [mm] LPS, in order along the polygon; the first point is not repeated at the end
};

/// A structure ("region of interest"): its contours on parallel slices.
struct Roi {
  std::string name;                          ///< as written in the file
  int number = 0;                            ///< ROI number in the file
  std::string type;                          ///< RT ROI interpreted type ("ORGAN", "EXTERNAL", …) or empty
  std::array<int, 3> colour{255, 255, 255};  ///< display colour, 0…255
  std::vector<Contour> contours;
};

/// A structure of the file that has no closed contour and therefore cannot be meshed.
struct PassedOver {
  std::string name;
  std::string why;  ///< the reason in a few words: "empty", "only open curves or points"
};

/// Contours of one patient on parallel slices, all in one frame of reference.
struct ContourSet {
  std::string source;              ///< file from which the contours were read
  std::string label;               ///< label of the structure set
  std::string frame_of_reference;  ///< UID of the DICOM frame of reference; may be empty
  std::vector<Roi> rois;
  std::vector<PassedOver> passed_over;  ///< structures of the file that are not among `rois`
  std::vector<std::string> notes;       ///< messages to the user about parts of structures that the reader left out
};

}  // namespace stylet
