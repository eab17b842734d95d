// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/field.hpp"
#include "stylet/core/types.hpp"

#include <array>
#include <cstdint>

namespace stylet {

/// The state of the needle's tip.
enum class TipState {
  air,       ///< outside the patient: before the first contact, or after the needle has been drawn out
  pressing,  ///< touches tissue and does not cut yet
  cutting,   ///< lengthens the track
  in_track,  ///< behind the deepest point reached, in tissue that is already cut
  bone,      ///< presses against a rigid region
  exited     ///< has left the tissue through the far side
};
const char* to_string(TipState state);

/// One step: its inputs and its results. This one type goes from the coupling through the simulation to recordings, to
/// the real-time loop and to the live view. The list of fields below says which of them tables and files carry. It owns
/// no memory: copying a Step never allocates.
///
/// Force and torque are those that the hand exerts on the needle's base: axial along the base's axis, positive when
/// pushing in; lateral towards the patient's left; sagittal = axial × lateral (towards posterior for a needle that goes
/// to superior).
struct Step {
  /// Warnings about a step. Whenever a step uses a fallback, it sets the flag for it.
  enum Flag : unsigned {
    /// The balance was broken off and the last iterate kept. Cure: a smaller time step.
    not_converged = 1u << 0,
    contact_cycling = 1u << 1,  ///< the stick/slip state of a contact was frozen for one sub-step
    /// The compliance at the needle's place has not been computed yet. The compliance of the tip's last place stands in
    /// for it, and new contacts wait. Cure: call prepare() between steps, or let a worker (supply()) keep ahead. With
    /// the tip in the air: the needle entered the tissue before any compliance was there, and has to be drawn out.
    compliance_missing = 1u << 2,
    out_of_contacts = 1u << 3,  ///< no room for another contact; raise CouplingSettings::capacity
    too_fast = 1u << 4,         ///< the base moved further in one step than the sub-steps can follow
    invalid_input = 1u << 5,    ///< the pose is not finite, or dt ≤ 0: the step was not taken
    /// The needle is inside the tissue without a contact, its tip in the air or exited: it was placed there, went in
    /// flat to the surface, or had passed through. No force resists it; it has to be drawn out. Not set where
    /// compliance_missing reports the same, nor for a needle that has buckled and slid off the patient's surface (event
    /// `grazed`): it lies on the surface until it is drawn out.
    no_contact_inside = 1u << 6,
    /// A program's own law of cutting gave a number that is negative or not finite; the built-in law stood in for it.
    unusable_law = 1u << 7
  };
  /// With one of these flags the force is not a solution of the model and must not reach a hand.
  static constexpr unsigned kDistrusted = not_converged | invalid_input;

  // Filled in by the simulation; zero in a Step that Insertion::step() returns.
  double time_s = 0.0;  ///< simulated time at the end of the step
  /// Duration of the step as passed in. Equal dt and base poses from the same start give bitwise equal results.
  double dt_s = 0.0;
  /// Base depth: how far the tip of a rigid straight needle on this base would be beyond the entry point.
  double base_depth_mm = 0.0;
  double force_axial_N = 0.0;
  double force_sagittal_N = 0.0;
  double force_lateral_N = 0.0;

  // Filled in by the coupling.
  Pose base;                          ///< [mm] LPS, pose to which the hand brought the needle's base
  Vec3 hand_force_N = Vec3::Zero();   ///< LPS, force of the hand on the base
  Vec3 torque_Nmm = Vec3::Zero();     ///< LPS, torque of the hand about the base
  Vec3 guide_force_N = Vec3::Zero();  ///< LPS, force of the guide template on the shaft
  Vec3 tip_mm = Vec3::Zero();         ///< LPS, the needle's tip
  TipState tip_state = TipState::air;
  int contacts = 0;                ///< number of contacts, the tip included when it touches
  int sticking = 0;                ///< number of contacts that stick
  int iterations = 0;              ///< iterations of the solver, summed over the sub-steps
  int pivots = 0;                  ///< changes of contact states
  int remeshings = 0;              ///< changes of the mesh, which ContactCompliance::remeshing() lists
  double inserted_mm = 0.0;        ///< length of shaft inside the tissue
  double sliding_share = 0.0;      ///< share of the inserted length that slides
  double sliding_out_share = 0.0;  ///< share of the inserted length that slides out of the tissue
  unsigned flags = 0;              ///< bits of Flag; 0: no warning, or a recording without flags

  // Filled in by the program that runs the steps.
  /// Thread CPU time of the step [µs]: the only field that differs between two runs of the same steps.
  double step_us = 0.0;
  /// Number of unrecorded steps at rest between the previous record and this one: they repeat the dt and base of the
  /// previous record, and their results equal its results within the tolerance of is_at_rest().
  std::int64_t rest_steps = 0;
};

template <>
inline constexpr bool record::has_check<Step> = true;

/// The columns of forces.csv and of /steps in run.h5. Their order is that in a file, from which the check of a row is
/// made: a new field is the last one.
void columns(auto& visit, record::Of<Step> auto& s) {
  using record::Field, record::kFile;
  visit(Field("time_s", "s", "simulated time at the end of the step"), s.time_s);
  visit(Field("dt_s", "s", "duration of the step").only(kFile).since(2).unknown_before(), s.dt_s);
  visit(Field("base{}_mm", "mm", "pose of the base: its place, LPS").only(kFile).since(2).apart().unknown_before(),
        s.base.origin);
  const Field turn = Field("", "", "its orientation, a quaternion").only(kFile).since(2).unknown_before();
  const std::array names{"base_qx", "base_qy", "base_qz", "base_qw"};
  for (const Eigen::Index k : {3, 0, 1, 2})
    visit(turn.named(names[static_cast<std::size_t>(k)]), s.base.rotation.coeffs()[k]);
  visit(Field("base_depth_mm", "mm",
              "how far the tip of a rigid, straight needle on the same base would lie beyond the entry point"),
        s.base_depth_mm);
  visit(Field("force_axial_N", "N",
              "force of the hand on the needle along the axis of the base, positive when pushing in")
            .digits(9),
        s.force_axial_N);
  visit(Field("force_sagittal_N", "N",
              "force of the hand across the needle, in the direction axial × lateral (towards posterior for a needle "
              "that goes to superior)")
            .digits(9),
        s.force_sagittal_N);
  visit(Field("force_lateral_N", "N", "force of the hand across the needle, towards the patient's left").digits(9),
        s.force_lateral_N);
  visit(Field("torque{}_Nmm", "N mm", "torque of the hand about the base point, LPS axes").digits(9).apart(),
        s.torque_Nmm);
  visit(Field("tip{}_mm", "mm", "position of the real tip, LPS").apart(), s.tip_mm);
  visit(Field("tip_state", "",
              "`air`, `pressing` (touches, does not cut), `cutting`, `in_track` (in tissue that is already cut), "
              "`bone`, `exited`"),
        s.tip_state);
  visit(Field("contacts", "", "number of contact points on the needle"), s.contacts);
  visit(Field("sticking", "", "number of these contacts that stick"), s.sticking);
  visit(Field("iterations", "", "iterations of the coupled solver"), s.iterations);
  visit(Field("step_us", "µs", "processor time of the step").digits(1), s.step_us);
  visit(Field("rest_steps", "", "number of steps at rest between the row before and this row").only(kFile).since(3),
        s.rest_steps);
  visit(Field("flags", "", "warnings of the step, with the bits of the C interface").only(kFile).since(4), s.flags);
}

}  // namespace stylet
