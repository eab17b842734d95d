// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shape.hpp"
#include "stylet/mesher/mesher.hpp"

namespace stylet::meshing {

/// One future region of the mesh.
struct Structure {
  std::string name;  ///< canonical name
  ShapePtr shape;
  double offset = 0;  ///< [mm] its surface is where distance = offset; chosen so that volumes are met
  /// [mm³] of the part of the input that no structure of higher priority takes; 0 = generated.
  double input_volume = 0;
  double whole_volume = 0;     ///< [mm³] of the structure as it is in the input, all of it; 0 = generated
  std::vector<Vec3> boundary;  ///< [mm] LPS, points on the boundary in the input
  bool target = false;
  bool generated = false;  ///< made by the mesher, not part of the input
};

/// A solid that its members share without gaps: a point of the solid belongs to the member below whose surface it is
/// deepest. A structure of its own is the only member of its layer.
struct Layer {
  ShapePtr solid;
  double offset = 0;         ///< [mm]
  std::vector<int> members;  ///< positions in Anatomy::structures
  Eigen::AlignedBox3d box;   ///< [mm] LPS, contains the solid with a margin
  bool clipped = false;      ///< whether it counts only inside the last layer, the body
};

/// All structures to be meshed. Tells to which region any point belongs.
struct Anatomy {
  std::string source;
  std::vector<Structure> structures;
  std::vector<Layer> layers;  ///< highest priority first; the body is last
  std::vector<std::string> notes;
  Index contour_points = 0;
  Index contour_points_kept = 0;

  /// Appends a structure as a layer of its own.
  void add(Structure structure);
  /// Appends structures that share one solid as one layer.
  void add(ShapePtr solid, std::vector<Structure> members);
  /// Label of a point: 0 outside, else 1 + position of the structure that contains p. @param p [mm] LPS
  [[nodiscard]] int label(const Vec3& p) const;
  /// Signed distance [mm] between p and the surface between two labels (0 = outside); negative on the side of the label
  /// with higher priority.
  [[nodiscard]] double interface_distance(int label_a, int label_b, const Vec3& p) const;
  /// Signed distance [mm] between p and the surface of a structure without the parts that other structures take;
  /// negative inside. What belongs inside it, as the urethra does in the gland, takes no part of it. Exact near that
  /// surface, but where surfaces meet.
  [[nodiscard]] double distance_to(int structure, const Vec3& p) const;
  /// p moved onto the surface between two labels.
  [[nodiscard]] Vec3 project(int label_a, int label_b, Vec3 p) const;
  /// Number of the layer to which a label belongs, -1 = none.
  [[nodiscard]] int layer_of(int label) const;
  /// Position of the structure to which a point in the layer's solid belongs.
  [[nodiscard]] int member(const Layer& layer, const Vec3& p) const;
  [[nodiscard]] Eigen::AlignedBox3d box() const;
  /// Signed distance between p and the union of the target structures [mm]; negative inside.
  [[nodiscard]] double target_distance(const Vec3& p) const;
  [[nodiscard]] Eigen::AlignedBox3d target_box() const;
  [[nodiscard]] const Structure* find(std::string_view name) const;
};

/// Rank of a region where structures overlap; the lowest rank wins. Small and inner structures come first: urethra,
/// zones, prostate (or planning volume), seminal vesicles, bladder, rectal lumen, rectum, pubic arch, femurs, other
/// named structures, band, soft layers, body.
int priority(std::string_view canonical);

/// The structures of a contour set, without those that the mesher generates.
Result<Anatomy> anatomy_of(const ContourSet& contours, const MeshOptions& options, const Progress& progress);

/// The structures of a label mask, without those that the mesher generates.
Result<Anatomy> anatomy_of(const LabelImage& image, const MeshOptions& options, const Progress& progress);

/// Adds what the input lacks: a body with perineal skin around the anatomy, the stiff band that ties the gland to it,
/// and soft layers.
void add_surroundings(Anatomy& anatomy, const MeshOptions& options);

/// Adds the soft layers that the input lacks. Needs a body.
void add_soft_layers(Anatomy& anatomy, const SoftLayers& layers);

/// Sets the offsets so that each solid has the volume of its input, computes which part of each structure is left after
/// structures of higher priority, and notes overlaps.
void settle_overlaps(Anatomy& anatomy);

}  // namespace stylet::meshing
