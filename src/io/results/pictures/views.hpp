// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pictures/stage.hpp"
#include "stylet/geom/tied_surface.hpp"
#include "stylet/io/recording_io.hpp"

/// The views that the pictures of a report show. Every function makes one stage, ready to draw.
namespace stylet::results {

/// Data that all pictures of one run share.
struct PictureInput {
  const RunRecording& run;
  std::span<const RegionView> regions;
  std::span<const TiedSurface> surfaces;  ///< (regions)
  const Frame& deepest;                   ///< determines the framing and the range of the displacement colours
};

/// A plane through the anatomy, seen from one side.
struct Section {
  Viewpoint view;
  Vec3 origin = Vec3::Zero();  ///< [mm] LPS
};
Section sagittal_section(const PictureInput& input);    ///< through the needle, seen from the patient's left
Section transverse_section(const PictureInput& input);  ///< through the target's centre, seen from the feet

Viewpoint oblique_viewpoint();  ///< from the patient's left, front and a little below

/// Layers of a picture, in the order in which they are drawn.
using Layers = std::vector<vtkSmartPointer<vtkRenderer>>;

Layers view_3d(const PictureInput& input, const Frame& frame);
/// A section with the deformed regions filled and outlined, their undeformed outlines as thin lines, and the needle
/// projected onto the plane.
Layers view_section(const PictureInput& input, const Frame& frame, const Section& section);
/// A section coloured by the magnitude of displacement.
Layers view_displacement(const PictureInput& input, const Frame& frame, const Section& section);

}  // namespace stylet::results
