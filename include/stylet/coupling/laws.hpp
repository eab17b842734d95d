// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/bevel.hpp"
#include "stylet/coupling/cutting_model.hpp"

#include <limits>
#include <memory>
#include <vector>

namespace stylet {

/// Friction between shaft and tissue per unit of inserted length. Static limit D; sliding C + b |v|, C ≤ D, up to a
/// speed beyond which it grows no more: b was measured on slow needles, and tissue that springs back along the shaft
/// after a puncture is fast.
/// @cite Okamura2004
struct FrictionLaw {
  double static_N_per_mm = 0.0;                                          ///< D
  double coulomb_N_per_mm = 0.0;                                         ///< C
  double viscous_Ns_per_mm2 = 0.0;                                       ///< b
  double viscous_to_mm_per_s = std::numeric_limits<double>::infinity();  ///< where C + b |v| ends
};

/// What a region does to the needle.
struct RegionLaws {
  double cutting_N = 0.0;   ///< axial force at which the tip begins to cut
  double puncture_N = 0.0;  ///< force that breaks the region's surface, 0 = no membrane
  FrictionLaw friction;
  bool rigid = false;        ///< bone: all its nodes are fixed, the tip cannot cut it
  bool surrounding = false;  ///< fills the space between organs; its membrane is the outer surface only
  int organ = -1;  ///< regions of one organ (the gland's zones) have no membrane between them; -1 = on its own
  double stiffening_MPa = 0.0;  ///< k₂ of DentLaw: how the dent under the tip stiffens; 0 = linear
};

/// Force that breaks the surface between two regions when the tip goes from `from` into `to`. The surface belongs to
/// the organ, not to the tissue that surrounds it; between two organs the stronger membrane counts.
/// @param from region number, -1 outside the patient
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

/// How tissue goes on yielding to a force that lasts (docs/theory/tissue.md): after a time t by
/// factor − (factor − 1) exp(−t / time_s) times as much as at once.
struct Creep {
  double factor = 1.0;  ///< ≥ 1; 1 = elastic
  double time_s = 1.0;  ///< > 0
  [[nodiscard]] bool is_any() const { return factor > 1.0; }
};

/// Settings of the contact between needle and tissue.
struct CouplingSettings {
  enum class Method {
    near_field,          ///< interpolated, with the mesh's own near field replaced by the needle's
    node_addition,       ///< a tissue node is put where the needle needs one
    node_repositioning,  ///< the nearest tissue node is moved there; one is added where it must not be moved
    embedded             ///< no node: the element's nodes carry interpolated forces
  };
  enum class Rule {
    interior,  ///< at the contact spacing, inside elements
    paper      ///< wherever the tip passes from one element into the next
  };
  enum class Engine {
    condensed,  ///< compliance among the points held only; the stiffness of the mesh is never touched
    woodbury,   ///< the full inverse, changed by the matrix inversion lemma
    bcs         ///< the full inverse, changed by boundary condition switches
  };
  enum class Solver {
    coupled,   ///< needle, tissue and laws in one system
    staggered  ///< needle and tissue in turn, damped
  };
  Method method = Method::near_field;
  Rule rule = Rule::interior;
  Engine engine = Engine::condensed;
  Solver solver = Solver::coupled;
  double needle_radius_mm = 0.635;  ///< as the tissue near it feels it
  double spacing_mm = 4.0;          ///< between contacts along the track
  double merge_mm = 1.27;           ///< contacts are never closer than this: twice the needle's radius
  double independence = 0.05;  ///< a contact must keep this share of its own compliance when its neighbours are held
  double tip_viscosity_Ns_per_mm =
      2e-3;  ///< cutting force grows by this times the speed of cutting; makes a puncture's drop a motion
  double bone_damping_s =
      3e-3;  ///< of the needle's bending while its tip stands on bone; makes a snap there a motion, as above
  double zero_band_mm_per_s = 0.005;  ///< slower sliding than this is sticking (Karnopp 1985)
  double grazing_cos = 0.17;  ///< the tip slides off where |axis · surface normal| is smaller (80° from the normal)
  double max_advance_mm = 0.25;             ///< of the base in one sub-step
  double axial_compliance_mm_per_N = 2e-3;  ///< of the steel shaft, L / (E A)
  double join_mm = 1.27;  ///< a new entry this near to an old track joins it: twice the needle's radius
  Bevel bevel;            ///< of the tip
  std::shared_ptr<const CuttingModel> cutting;  ///< a program's own law of cutting; null = the built-in law
  Creep creep;                                  ///< of the tissue
  int capacity = 96;                            ///< largest number of contacts
  int spare_nodes = 1500;                       ///< whose compliance is kept beyond what was there before
  double tolerance = 1e-8;  ///< coupled solver: error of a balance, as a force over the largest one or 1 N
  double damping = 1.0;     ///< of the staggered solver: springs on the needle, over the tissue's own stiffness there
  double needle_node_mm = 0.0;  ///< staggered: forces go to the nearest multiple of this along the needle; 0 = where
                                ///< they act
};

/// Whether tissue stiffens under the tip as RegionLaws::stiffening_MPa says: other methods and the staggered solver
/// take all tissue as linear.
[[nodiscard]] inline bool knows_stiffening(const CouplingSettings& settings) {
  return settings.method == CouplingSettings::Method::near_field &&
         settings.solver == CouplingSettings::Solver::coupled;
}

}  // namespace stylet
