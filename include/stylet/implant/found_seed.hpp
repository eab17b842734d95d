// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// A seed that was found on images after the implant.
struct FoundSeed {
  Vec3 at_mm = Vec3::Zero();  ///< [mm] LPS in the frame of the plan, its centre
  std::optional<Vec3> axis;   ///< unit vector along it; empty: the images do not show it
  std::string where;          ///< its place in the file for messages, e.g. "found.csv, line 5"
};

/// The seeds of a file.
struct FoundSeeds {
  std::string file;
  std::string frame_of_reference;  ///< UID of the DICOM frame of reference; may be empty
  std::vector<FoundSeed> seeds;    ///< at least one
  std::vector<std::string> notes;  ///< sentences for the user
};

}  // namespace stylet
