// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>

namespace stylet {

/// The state of the needle's tip.
enum class TipState {
  air,       ///< outside the patient, before or after
  pressing,  ///< touches tissue that it does not cut yet
  cutting,   ///< moves the cut forward
  in_track,  ///< behind the deepest point reached, in tissue already cut
  bone,      ///< against a rigid region
  exited     ///< through the far side
};
const char* to_string(TipState state);

/// A step: what went into it and what came out. The one value that goes from the coupling through the simulation to
/// recordings, to the loop with a clock, and to those who watch; what a file or a protocol has of it is written down
/// there. It owns nothing: copying one never allocates.
///
/// Force and torque are what the hand exerts on the needle's base: axial along the base's axis, positive when pushing
/// in; lateral towards the patient's left, sagittal = axial × lateral (towards posterior for a needle going superior).
struct Step {
  /// Warnings about a step, each with what to do about it: nothing is repaired in silence.
  enum Flag : unsigned {
    not_converged = 1u << 0,       ///< the balance was broken off, the last iterate kept; use a smaller time step
    contact_cycling = 1u << 1,     ///< a stick/slip state was frozen for one sub-step
    compliance_missing = 1u << 2,  ///< not there yet where the needle is: that of the tip's last place stood in, and
                                   ///< contacts wait; prepare() between steps, or let a worker (supply()) keep ahead.
                                   ///< A tip in the air: it went in before there was any, and is to be drawn out
    out_of_contacts = 1u << 3,     ///< raise CouplingSettings::capacity
    too_fast = 1u << 4,            ///< the base moved further in one step than the sub-steps can follow
    invalid_input = 1u << 5,       ///< a pose that is not finite, or dt ≤ 0: the step was not taken
    no_contact_inside = 1u << 6,   ///< no contact, tip in the air or exited, and yet inside the tissue: it was put
                                   ///< there, went in flat to the surface, slipped off it, or had gone through; nothing
                                   ///< resists it, and it is to be drawn out. Where compliance_missing says so already
                                   ///< it is not said twice
    unusable_law = 1u << 7         ///< a program's own law of cutting gave a number that is negative or not finite; the
                                   ///< built-in law stood in for it
  };
  static constexpr unsigned kDistrusted = not_converged | invalid_input;  ///< with one of them: not the model's force

  // Of the simulation: zero in what Insertion::step() returns.
  double time_s = 0.0;  ///< simulated, at the end of the step
  double dt_s = 0.0;    ///< as it was given: steps of the same dt and base from the same start give the same bits
  double base_depth_mm = 0.0;  ///< how far a rigid straight needle's tip would be beyond the entry point
  double force_axial_N = 0.0;
  double force_sagittal_N = 0.0;
  double force_lateral_N = 0.0;

  // Of the coupling.
  Pose base;                          ///< [mm] LPS, where the hand brought the needle's base
  Vec3 hand_force_N = Vec3::Zero();   ///< LPS
  Vec3 torque_Nmm = Vec3::Zero();     ///< LPS, about the base
  Vec3 guide_force_N = Vec3::Zero();  ///< LPS, exerted by the guide template on the shaft
  Vec3 tip_mm = Vec3::Zero();         ///< LPS
  TipState tip_state = TipState::air;
  int contacts = 0;                ///< tip included when it touches
  int sticking = 0;                ///< of the contacts
  int iterations = 0;              ///< of the solver, summed over sub-steps
  int pivots = 0;                  ///< changes of contact state
  int remeshings = 0;              ///< changes of the mesh: ContactCompliance::remeshing() has them
  double inserted_mm = 0.0;        ///< length of shaft in tissue
  double sliding_share = 0.0;      ///< share of the inserted length that slides
  double sliding_out_share = 0.0;  ///< share of the inserted length that slides out of the tissue
  unsigned flags = 0;              ///< of Flag; 0 = all is well, or a recording that does not have them

  // Of whoever runs the steps.
  double step_us = 0.0;  ///< thread CPU time of the step [µs]; the only number that differs between two runs
  /// Steps at rest between the one recorded before and this one: with its dt and base, and results as near as
  /// is_at_rest().
  std::int64_t rest_steps = 0;
};

}  // namespace stylet
