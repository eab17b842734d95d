// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/gland_form.hpp"
#include "stylet/probe/probe_contact.hpp"
#include "stylet/sim/model.hpp"

#include <memory>

namespace stylet {

/// A probe in a patient: its seat, the wall that it presses, and the gland that it deforms.
class PatientProbe {
 public:
  /// The parts of a patient that the probe needs; they must outlive it.
  struct Patient {
    const Tissue& tissue;
    const Topology& topology;
    std::span<const int> gland_regions;
  };

  /// Solves for the wall's compliance, which takes seconds.
  /// @param settings the motions are around this place; with in_contours it is the reference, where nothing moves
  /// @param where name of the patient in messages
  /// Errors: a patient without a gland or a rectum, or whose rectum is nowhere near the probe.
  static Result<PatientProbe> prepare(const Patient& patient, const ProbeSettings& settings, const std::string& where,
                                      const Progress& progress = {});
  /// The probe of a model's scenario, whose probe.kind is not none. The model must outlive it.
  static Result<PatientProbe> prepare(const Model& model, const std::string& where, const Progress& progress = {});

  /// Presses with the probe where the stepper holds it. Does not allocate.
  ProbePress press(const ProbeSettings& settings) { return contact_.press(capsule_of(place(settings))); }
  [[nodiscard]] ProbePlace place(const ProbeSettings& settings) const { return probe_place(settings, seat_); }

  /// The gland after the last press().
  [[nodiscard]] GlandForm gland() const;

  [[nodiscard]] ProbeContact& contact() { return contact_; }
  [[nodiscard]] const ProbeContact& contact() const { return contact_; }
  [[nodiscard]] const WallCompliance& wall() const { return contact_.wall(); }
  [[nodiscard]] const ProbeSeat& seat() const { return seat_; }

 private:
  PatientProbe(const ProbeSeat& seat, ProbeContact contact, GlandMeasure measure)
      : seat_(seat), contact_(std::move(contact)), measure_(std::move(measure)) {}

  ProbeSeat seat_;
  ProbeContact contact_;
  GlandMeasure measure_;
};

/// The figures of a report about the probe of a scenario.
struct ProbeReport {
  ProbeSettings settings;
  ProbePlace place;
  ProbePress press;
  /// [N] force of a probe that has stayed until the tissue crept, with the delayed moduli; without creep that of
  /// `press`.
  Vec3 lasting_force_N = Vec3::Zero();
  GlandForm gland;
  int wall_points = 0;
  double prepare_s = 0.0;
  double megabytes = 0.0;
};

/// Presses with a probe where the stepper holds it and measures what it does.
/// @param creep by which the moduli fall while a probe stays (creep_of())
ProbeReport report_probe(PatientProbe& probe, const ProbeSettings& settings, double creep);
/// Puts the probe of a model's scenario in and measures what it does. Errors: as PatientProbe::prepare().
Result<ProbeReport> report_probe(const Model& model, const std::string& where, const Progress& progress = {});

/// A line of a report.
struct ProbeFact {
  std::string name;
  std::string text;
};
/// The report in words: where the probe is, its force, and how it deforms the gland.
std::vector<ProbeFact> probe_facts(const ProbeReport& report);

}  // namespace stylet
