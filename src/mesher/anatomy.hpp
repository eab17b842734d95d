// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shape.hpp"
#include "stylet/mesher/mesher.hpp"

namespace stylet::meshing {

/// One region of the mesh to be.
struct Structure {
  std::string name;  ///< canonical
  ShapePtr shape;
  double offset = 0;           ///< [mm] its surface is where distance = offset; set so that volumes are met
  double input_volume = 0;     ///< [mm³] of the input that no structure of higher priority claims; 0 = generated
  std::vector<Vec3> boundary;  ///< [mm] LPS, points of the input's boundary
  bool target = false;
  bool generated = false;  ///< made by the mesher, not in the input
};

/// A solid that its members share without gaps: a point of the solid belongs to the member whose surface it lies
/// deepest in. A structure of its own is the only member of its layer.
struct Layer {
  ShapePtr solid;
  double offset = 0;         ///< [mm]
  std::vector<int> members;  ///< indices of structures
  Eigen::AlignedBox3d box;   ///< [mm] LPS, holds the solid with some margin
  bool clipped = false;      ///< counts only inside the last layer, the body
};

/// Everything to be meshed: which region any point belongs to.
struct Anatomy {
  std::string source;
  std::vector<Structure> structures;
  std::vector<Layer> layers;  ///< highest priority first; the body last
  std::vector<std::string> notes;
  Index contour_points = 0;
  Index contour_points_kept = 0;

  /// Appends a structure in a layer of its own.
  void add(Structure structure);
  /// Appends structures that share one solid.
  void add(ShapePtr solid, std::vector<Structure> members);
  /// 0 outside, else 1 + index of the structure at p. @param p [mm] LPS
  [[nodiscard]] int label(const Vec3& p) const;
  /// Signed distance [mm] of p from the surface between two labels (0 = outside), negative on the side of higher
  /// priority.
  [[nodiscard]] double interface_distance(int label_a, int label_b, const Vec3& p) const;
  /// p moved onto that surface.
  [[nodiscard]] Vec3 project(int label_a, int label_b, Vec3 p) const;
  /// Index of the layer a label belongs to.
  [[nodiscard]] int layer_of(int label) const;
  /// Structure index in a layer whose solid holds p.
  [[nodiscard]] int member(const Layer& layer, const Vec3& p) const;
  [[nodiscard]] Eigen::AlignedBox3d box() const;
  /// Distance from the union of the target structures [mm]; negative inside.
  [[nodiscard]] double target_distance(const Vec3& p) const;
  [[nodiscard]] Eigen::AlignedBox3d target_box() const;
  [[nodiscard]] const Structure* find(std::string_view name) const;
};

/// Rank of a region where structures overlap, lowest wins: small and inner ones first. Urethra, zones, prostate (or
/// planning volume), seminal vesicles, bladder, rectum, pubic arch, femurs, other named structures, band, body.
int priority(std::string_view canonical);

/// Structures of a contour set, without generated ones.
Result<Anatomy> anatomy_of(const ContourSet& contours, const MeshOptions& options, const Progress& progress);

/// Structures of a label mask, without generated ones.
Result<Anatomy> anatomy_of(const LabelImage& image, const MeshOptions& options, const Progress& progress);

/// Adds what the input does not have: a body with perineal skin around the anatomy, and the stiff band that ties the
/// gland to it. Crops or rounds a body that is there.
void add_surroundings(Anatomy& anatomy, const MeshOptions& options);

/// Adds the soft layers that the input does not have. Needs a body.
void add_soft_layers(Anatomy& anatomy, const SoftLayers& layers);

/// Sets the offsets so that each structure's own field has the volume of its input, and works out which part of it is
/// left after structures of higher priority; notes overlaps.
void settle_overlaps(Anatomy& anatomy);

}  // namespace stylet::meshing
