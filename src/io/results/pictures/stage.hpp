// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/io/region_views.hpp"

#include <vtkSmartPointer.h>

#include <array>
#include <span>
#include <string>

class vtkActor;
class vtkLookupTable;
class vtkPolyData;
class vtkRenderer;

/// A picture is drawn in layers: stages, on which the anatomy is seen in parallel projection, and pages of text and
/// marks. Sizes are in pixels of the finished picture, places on it fractions of its width and height from lower left.
namespace stylet::results {

inline constexpr Colour kWhite{1, 1, 1}, kInk{0.13, 0.14, 0.16}, kPale{0.50, 0.52, 0.55}, kSteel{0.16, 0.19, 0.24};

/// Where the observer stands. Image right is direction of view × up.
struct Viewpoint {
  Vec3 towards_viewer = -Vec3::UnitY();  ///< unit vector
  Vec3 up = Vec3::UnitZ();               ///< unit vector, at right angles to it
  [[nodiscard]] Vec3 right() const { return up.cross(towards_viewer); }
};

/// The part of the picture that a stage takes.
struct Area {
  double left = 0, bottom = 0, right = 1, top = 1;
  [[nodiscard]] double width() const;   ///< [pixels]
  [[nodiscard]] double height() const;  ///< [pixels]
};

/// What a stage shows: centre and half height [mm] of its plane.
struct Framing {
  Vec3 centre = Vec3::Zero();
  double half_height = 1;
};

/// Framing that holds all points with a margin.
Framing frame_points(std::span<const Vec3> points, const Viewpoint& view, const Area& area, double margin = 0.08);

vtkSmartPointer<vtkRenderer> make_stage(const Viewpoint& view, const Framing& framing, const Area& area);
vtkSmartPointer<vtkRenderer> make_page();  ///< the whole picture, white

/// @return the actor, already on the stage
vtkActor* add_surface(vtkRenderer* stage, vtkPolyData* data, const Colour& colour, double opacity);
vtkActor* add_lines(vtkRenderer* stage, vtkPolyData* data, const Colour& colour, double width);
vtkActor* add_flat(vtkRenderer* stage, vtkPolyData* data, const Colour& colour);  ///< without light and shade

/// Bar of a round length with its length in mm, lower right.
void add_scale_bar(vtkRenderer* page, const Framing& framing, const Area& area);

/// Text centred on a place.
void add_text(vtkRenderer* page, const std::string& text, double x, double y, int size, const Colour& colour = kInk);

/// Letters of the patient directions the four edges point to (L, R, A, P, S, I), just outside of the stage.
void add_edge_letters(vtkRenderer* page, const Viewpoint& view, const Area& area);

/// Colours of a displacement map from 0 to `most` [mm] (viridis), and their bar with a label every `step` mm.
vtkSmartPointer<vtkLookupTable> displacement_colours(double most);
void add_colour_bar(vtkRenderer* page, vtkLookupTable* colours, double step);

/// A cube with the patient directions on its faces, for the lower left corner.
vtkSmartPointer<vtkRenderer> orientation_cube(const Viewpoint& view);

/// The colour mixed with white (share > 0) or black (share < 0).
Colour lighter(const Colour& colour, double share);

/// 1, 2 or 5 times a power of ten, at most `value`.
double round_down(double value);

}  // namespace stylet::results
