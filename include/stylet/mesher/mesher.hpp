// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/geom/contours.hpp"
#include "stylet/geom/label_image.hpp"
#include "stylet/geom/mesh_preset.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/geom/soft_layers.hpp"
#include "stylet/geom/surface.hpp"

#include <map>
#include <optional>

namespace stylet {

/// Options of mesh_contours() and mesh_labels().
struct MeshOptions {
  MeshPreset preset = MeshPreset::standard;
  Index nodes = 0;  ///< wanted number of nodes, met within 3 %; 0 = default of the preset (3,000 / 570)
  /// [mm] contour points closer than this to the polygon without them are dropped; 0 keeps all points.
  double cull_tolerance_mm = 0.3;
  /// Regions that the user assigns: ROI name, label name, or label number as text → region name. The other structures
  /// are recognised by their names (choose_structures()).
  std::map<std::string, std::string> regions;
  std::vector<std::string> skip;  ///< names of input structures, or numbers of labels as text, to leave out
  /// Whether to add a stiff band from the gland's anterior-inferior end if the input has no pubic arch.
  bool stiff_band = true;
  SoftLayers layers;  ///< thicknesses of layers to add if the input lacks them; MeshPreset::paper adds none
};

/// How well a region of the mesh reproduces the input.
struct RegionReport {
  std::string name;
  Index tets = 0;
  double volume_cc = 0;  ///< [cm³] volume of the region in the mesh
  /// [cm³] of the structure in the input, without the parts that other structures take; 0 for regions that the mesher
  /// made itself (body, band, soft layers)
  double input_volume_cc = 0;
  double structure_volume_cc = 0;  ///< [cm³] of the whole structure in the input, as `stylet info` and the dose have it
  double surface_mean_mm = 0;      ///< mean distance between the region's boundary in the input and in the mesh
  double surface_max_mm = 0;       ///< largest distance between these two boundaries
};

/// Figures about a mesh and how well it reproduces its input.
struct MeshReport {
  MeshQuality quality;
  std::vector<RegionReport> regions;
  double surface_mean_mm = 0;      ///< mean distance of all boundary points of the input from the mesh's boundaries
  double surface_max_mm = 0;       ///< largest distance of a boundary point from the mesh's boundaries
  Index contour_points = 0;        ///< number of contour points in the input
  Index contour_points_kept = 0;   ///< number of contour points after culling
  double seconds = 0;              ///< time that meshing took [s]
  std::vector<std::string> notes;  ///< decisions that the user should know (body added, structures left out, …)
};

/// A mesh of a patient and the report about it.
struct MeshedAnatomy {
  TetMesh mesh;  ///< regions have canonical names, see canonical_region()
  MeshReport report;
};

/// Meshes contours on parallel slices as one conforming mesh: element faces lie on every anatomical boundary and
/// neighbours share their nodes. Elements are finest in the target. Deterministic: the same input gives the same mesh.
Result<MeshedAnatomy> mesh_contours(const ContourSet& contours, const MeshOptions& options,
                                    const Progress& progress = {});

/// Meshes a label mask; otherwise as mesh_contours().
Result<MeshedAnatomy> mesh_labels(const LabelImage& image, const MeshOptions& options, const Progress& progress = {});

/// Simplifies a contour: drops points closer than `tolerance_mm` to the polygon that remains without them
/// (Douglas–Peucker on the closed curve).
Contour cull(const Contour& contour, double tolerance_mm);

/// Canonical name of a structure, found by its synonyms; upper and lower case and separators do not matter. Canonical
/// names are prostate, peripheral_zone, transition_zone, central_zone, anterior_stroma, urethra, bladder, rectum,
/// pubic_arch, femur_left, femur_right, band, body, seminal_vesicles, the soft layers periprostatic_fat, levator,
/// ischiorectal_fat, subcutaneous_fat and rectal_lumen, and the planning volumes ctv, target, ptv and gtv. Only whole
/// names are recognised: planning helpers such as "optBladder" are not anatomy.
/// @return empty when the name is not recognised
std::string canonical_region(std::string_view name);

/// Region that a user means by assigning this name to a structure: the canonical name where it is recognised, with
/// "target" standing for the gland ("prostate"); otherwise the name itself.
std::string region_meant(std::string_view name);

/// Whether a region belongs to the target (the gland): prostate or its zones, else a planning volume (CTV, target, PTV,
/// GTV).
bool is_target_region(std::string_view canonical);

}  // namespace stylet
