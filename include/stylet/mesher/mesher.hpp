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

struct MeshOptions {
  MeshPreset preset = MeshPreset::standard;
  Index nodes = 0;                 ///< wanted number of nodes, hit within 3 %; 0 = the preset's default (3,000 / 570)
  double cull_tolerance_mm = 0.3;  ///< contour points closer than this to the polygon without them are superfluous
  /// The region of each structure that the user assigns by hand: ROI name, or label's name or "number as text" → region
  /// name. All other structures are recognised by their names (choose_structures()).
  std::map<std::string, std::string> regions;
  std::vector<std::string> skip;  ///< names of input structures, or labels' numbers as text, to leave out
  bool stiff_band = true;  ///< without a pubic arch in the input: add the band from the gland's anterior-inferior end
  SoftLayers layers;       ///< to be made where the input has none; MeshPreset::paper has none in any case
};

/// How well a region of the mesh reproduces its input.
struct RegionReport {
  std::string name;
  Index tets = 0;
  double volume_cc = 0;
  double input_volume_cc = 0;  ///< 0 where the mesher made the region itself (body, band)
  double surface_mean_mm = 0;  ///< distance input boundary → mesh boundary
  double surface_max_mm = 0;
};

struct MeshReport {
  MeshQuality quality;
  std::vector<RegionReport> regions;
  double surface_mean_mm = 0;
  double surface_max_mm = 0;
  Index contour_points = 0;       ///< read
  Index contour_points_kept = 0;  ///< left after culling
  double seconds = 0;
  std::vector<std::string> notes;  ///< decisions the user should know (body added, structures passed over, …)
};

struct MeshedAnatomy {
  TetMesh mesh;  ///< regions carry canonical names, see canonical_region()
  MeshReport report;
};

/// One conforming mesh of parallel contours: element faces on every anatomical boundary, shared nodes, finer in the
/// target, coarser outside. Deterministic: the same input gives the same mesh.
Result<MeshedAnatomy> mesh_contours(const ContourSet& contours, const MeshOptions& options,
                                    const Progress& progress = {});

/// The same for a label mask.
Result<MeshedAnatomy> mesh_labels(const LabelImage& image, const MeshOptions& options, const Progress& progress = {});

/// Drops points closer than `tolerance_mm` to the polygon that is left without them (Douglas–Peucker on the closed
/// curve).
Contour cull(const Contour& contour, double tolerance_mm);

/// Canonical name of a structure by its synonyms, case-insensitive, separators ignored: prostate, peripheral_zone,
/// transition_zone, central_zone, anterior_stroma, urethra, bladder, rectum, pubic_arch, femur_left, femur_right, band,
/// body, seminal_vesicles, the soft layers periprostatic_fat, levator, ischiorectal_fat, subcutaneous_fat and
/// rectal_lumen, and the planning volumes ctv, target, ptv, gtv; empty when not recognised. Whole names only:
/// planning helpers such as "optBladder" are not anatomy.
std::string canonical_region(std::string_view name);

/// What a user means who gives a structure this name: the canonical name where it is recognised, with "target" for the
/// gland, else the name itself.
std::string region_meant(std::string_view name);

/// Regions whose union is the target (the gland): prostate or its zones, else a planning volume (CTV, target, PTV,
/// GTV).
bool is_target_region(std::string_view canonical);

}  // namespace stylet
