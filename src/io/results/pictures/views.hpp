// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pictures/stage.hpp"
#include "stylet/io/recording_io.hpp"

/// The views that the pictures of a report show. Every function makes one stage, ready to draw.
namespace stylet::results {

/// What all pictures of one run have in common.
struct PictureInput {
  const RunRecording& run;
  std::span<const RegionView> regions;
  const Frame& deepest;  ///< sets framing and the range of the displacement colours
};

/// A plane through the anatomy that is seen from one side.
struct Section {
  Viewpoint view;
  Vec3 origin = Vec3::Zero();  ///< [mm] LPS
};
Section sagittal_section(const PictureInput& input);    ///< through the needle, seen from the patient's left
Section transverse_section(const PictureInput& input);  ///< through the target's centre, seen from the feet

Viewpoint oblique_viewpoint();  ///< from the patient's left, front and a little below

/// Layers of a picture, first drawn first.
using Layers = std::vector<vtkSmartPointer<vtkRenderer>>;

Layers view_3d(const PictureInput& input, const Frame& frame);
/// Regions filled and outlined as deformed, their initial outlines thin, the needle projected onto the plane.
Layers view_section(const PictureInput& input, const Frame& frame, const Section& section);
/// The same section coloured by the magnitude of displacement.
Layers view_displacement(const PictureInput& input, const Frame& frame, const Section& section);

}  // namespace stylet::results
