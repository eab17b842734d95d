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

/// A picture consists of layers: stages, which show the anatomy in parallel projection, and pages with text and marks.
/// Sizes are in pixels of the finished picture; positions are fractions of its width and height from the lower left.
namespace stylet::results {

inline constexpr Colour kWhite{1, 1, 1}, kInk{0.13, 0.14, 0.16}, kPale{0.50, 0.52, 0.55}, kSteel{0.16, 0.19, 0.24};

/// Direction from which the anatomy is seen. The right of the image is direction of view × up.
struct Viewpoint {
  Vec3 towards_viewer = -Vec3::UnitY();  ///< unit vector
  Vec3 up = Vec3::UnitZ();               ///< unit vector, perpendicular to towards_viewer
  [[nodiscard]] Vec3 right() const { return up.cross(towards_viewer); }
};

/// The part of the picture that a stage occupies.
struct Area {
  double left = 0, bottom = 0, right = 1, top = 1;
  [[nodiscard]] double width() const;   ///< [pixels]
  [[nodiscard]] double height() const;  ///< [pixels]
};

/// The part of the plane that a stage shows: its centre and half height [mm].
struct Framing {
  Vec3 centre = Vec3::Zero();
  double half_height = 1;
};

/// A framing that contains all points with a margin.
Framing frame_points(std::span<const Vec3> points, const Viewpoint& view, const Area& area, double margin = 0.08);

vtkSmartPointer<vtkRenderer> make_stage(const Viewpoint& view, const Framing& framing, const Area& area);
vtkSmartPointer<vtkRenderer> make_page();  ///< a white page of the size of the picture

/// Adds a surface to a stage. @return the actor, which belongs to the stage
vtkActor* add_surface(vtkRenderer* stage, vtkPolyData* data, const Colour& colour, double opacity);
vtkActor* add_lines(vtkRenderer* stage, vtkPolyData* data, const Colour& colour, double width);
vtkActor* add_flat(vtkRenderer* stage, vtkPolyData* data, const Colour& colour);  ///< without shading

/// Adds a scale bar of a round length, labelled in mm, at the lower right.
void add_scale_bar(vtkRenderer* page, const Framing& framing, const Area& area);

/// Adds a text centred at (x, y).
void add_text(vtkRenderer* page, const std::string& text, double x, double y, int size, const Colour& colour = kInk);

/// Adds the letters of the patient directions of the four edges (L, R, A, P, S, I), just outside of the stage.
void add_edge_letters(vtkRenderer* page, const Viewpoint& view, const Area& area);

/// The colours of a displacement map from 0 to `most` [mm] (viridis), and the colour bar with a label every `step` mm.
vtkSmartPointer<vtkLookupTable> displacement_colours(double most);
void add_colour_bar(vtkRenderer* page, vtkLookupTable* colours, double step);

/// A cube with the patient directions on its faces, for the lower left corner.
vtkSmartPointer<vtkRenderer> orientation_cube(const Viewpoint& view);

/// The colour mixed with white (share > 0) or black (share < 0).
Colour lighter(const Colour& colour, double share);

/// 1, 2 or 5 times a power of ten, at most `value`.
double round_down(double value);

}  // namespace stylet::results
