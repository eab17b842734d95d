// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/bevel.hpp"
#include "stylet/coupling/cutting_model.hpp"

#include <limits>
#include <memory>
#include <vector>

namespace stylet {

/// Friction between shaft and tissue per inserted length. Static limit D; sliding friction C + b |v|, C ≤ D. Above the
/// speed viscous_to_mm_per_s it stays constant: b was measured on slow needles, and tissue that springs back along the
/// shaft after a puncture is fast.
/// @cite Okamura2004
struct FrictionLaw {
  double static_N_per_mm = 0.0;     ///< D
  double coulomb_N_per_mm = 0.0;    ///< C
  double viscous_Ns_per_mm2 = 0.0;  ///< b
  /// Speed |v| above which sliding friction stays constant.
  double viscous_to_mm_per_s = std::numeric_limits<double>::infinity();
};

/// The laws of a region: how its tissue resists the needle.
struct RegionLaws {
  double cutting_N = 0.0;   ///< axial force at which the tip begins to cut
  double puncture_N = 0.0;  ///< axial force at which the region's surface breaks; 0: the surface has no membrane
  FrictionLaw friction;
  bool rigid = false;        ///< bone: all its nodes are fixed, the tip cannot cut it
  bool surrounding = false;  ///< whether the region fills the space between organs; only its outer surface has a
                             ///< membrane
  /// Regions of one organ, such as the gland's zones, have no membrane between them; −1: the region is an organ by
  /// itself.
  int organ = -1;
  double stiffening_MPa = 0.0;  ///< k₂ of DentLaw: how much the dent under the tip stiffens; 0: linear tissue
};

/// [N] Force that breaks the surface between two regions when the tip goes from `from` into `to`. The membrane belongs
/// to the organ, not to the tissue around it; between two organs the stronger membrane counts.
/// @param from region number, −1 outside the patient
inline double membrane_force(const std::vector<RegionLaws>& laws, int from, int to) {
  const RegionLaws& into = laws[static_cast<std::size_t>(to)];
  if (into.rigid) return std::numeric_limits<double>::infinity();
  if (from < 0) return into.puncture_N;
  const RegionLaws& out_of = laws[static_cast<std::size_t>(from)];
  if (into.organ >= 0 && into.organ == out_of.organ) return 0.0;
  if (into.surrounding) return out_of.surrounding ? 0.0 : out_of.puncture_N;
  if (out_of.surrounding) return into.puncture_N;
  return into.puncture_N > out_of.puncture_N ? into.puncture_N : out_of.puncture_N;
}

/// Creep of tissue under a lasting force (docs/theory/tissue.md): after a time t the displacement is factor − (factor −
/// 1) exp(−t / time_s) times the immediate displacement.
struct Creep {
  double factor = 1.0;  ///< ≥ 1; 1: elastic tissue
  double time_s = 1.0;  ///< > 0
  [[nodiscard]] bool is_any() const { return factor > 1.0; }
};

/// Settings of the interaction of needle and tissue.
struct CouplingSettings {
  enum class Method {
    near_field,     ///< contacts are interpolated, and the mesh's near field is replaced by the needle's
    node_addition,  ///< a node is added to the mesh at each contact
    /// The nearest node of the mesh is moved to the contact; where it must not be moved, a node is added.
    node_repositioning,
    embedded  ///< no node is added: forces are distributed over the element's nodes
  };
  enum class Rule {
    interior,  ///< at the contact spacing, inside elements
    paper      ///< wherever the tip passes from one element into the next
  };
  enum class Engine {
    condensed,  ///< only the compliance among the contacts is kept; the stiffness of the mesh never changes
    woodbury,   ///< the full inverse, updated by the matrix inversion lemma (Woodbury)
    bcs         ///< the full inverse, updated by boundary condition switches
  };
  enum class Solver {
    coupled,   ///< needle, tissue and laws in one system of equations
    staggered  ///< needle and tissue are solved in turn, with damping
  };
  Method method = Method::near_field;
  Rule rule = Rule::interior;
  Engine engine = Engine::condensed;
  Solver solver = Solver::coupled;
  double needle_radius_mm = 0.635;  ///< outer radius of the needle
  double spacing_mm = 4.0;          ///< distance between contacts along the track
  double merge_mm = 1.27;           ///< smallest distance between contacts: the needle's diameter
  /// A contact is created only if it keeps this share of its own compliance when its neighbours are held. A larger
  /// value refuses contacts earlier where elements are too large to tell them apart.
  double independence = 0.05;
  /// η: the cutting force grows by η times the speed of cutting. It gives the jump of the tip after a puncture a finite
  /// speed.
  double tip_viscosity_Ns_per_mm = 2e-3;
  /// Time constant of the needle's bending while its tip stands on bone, and in parts of a sub-step that has no balance
  /// as a whole. It gives a sudden slip of the tip, or a snap of the needle, a finite speed.
  double bone_damping_s = 3e-3;
  double zero_band_mm_per_s = 0.005;  ///< a contact that slides more slowly than this sticks @cite Karnopp1985
  /// The tip slides off a surface where |axis · surface normal| is smaller than this: more than 80° from the normal.
  double grazing_cos = 0.17;
  double max_advance_mm = 0.25;             ///< largest motion of the base in one sub-step
  double axial_compliance_mm_per_N = 2e-3;  ///< L / (E A) of the steel shaft
  double join_mm = 1.27;  ///< a new entry within this distance of an old track joins it: the needle's diameter
  Bevel bevel;            ///< of the needle's tip
  std::shared_ptr<const CuttingModel> cutting;  ///< a program's own law of cutting; null: the built-in law
  Creep creep;                                  ///< of the tissue
  int capacity = 96;                            ///< largest number of shaft contacts of a needle
  int needles = 1;                              ///< largest number of needles in the tissue at the same time
  /// From this number of contacts at rest on, needles at rest follow a needle that is balanced alone, instead of being
  /// balanced with it; at least 1. Raised, more contacts are balanced together, which is exact and slow.
  int follow_from = 48;
  int spare_nodes = 1500;  ///< room for nodes whose compliance is computed after the start
  /// Coupled solver: a balance has converged when the largest error, as a force, is below this part of the largest
  /// force or of 1 N.
  double tolerance = 1e-8;
  /// Staggered solver: stiffness of the springs on the needle, as a multiple of the tissue's own stiffness there.
  double damping = 1.0;
  /// Staggered solver: each force acts at the nearest multiple of this length along the needle; 0: where the contact
  /// is.
  double needle_node_mm = 0.0;
};

/// Largest number of shaft contacts of all needles; each needle at rest adds its tip to those of its shaft.
[[nodiscard]] inline int most_shaft_contacts(const CouplingSettings& settings) {
  return settings.needles * settings.capacity + settings.needles - 1;
}

/// Whether tissue stiffens under the tip by RegionLaws::stiffening_MPa. Methods other than near_field and the staggered
/// solver take all tissue as linear.
[[nodiscard]] inline bool knows_stiffening(const CouplingSettings& settings) {
  return settings.method == CouplingSettings::Method::near_field &&
         settings.solver == CouplingSettings::Solver::coupled;
}

}  // namespace stylet
