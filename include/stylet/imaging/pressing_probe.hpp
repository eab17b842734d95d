// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/moment.hpp"
#include "stylet/probe/patient_probe.hpp"

#include <memory>

namespace stylet {

/// A probe that presses a patient of whom pictures are made: it moves the tissue of a moment, with the needles and
/// seeds in it, by superposition (docs/theory/probe.md).
class PressingProbe {
 public:
  /// The probe in the patient of an open model. Errors: as PatientProbe::prepare().
  static Result<PressingProbe> prepare(std::shared_ptr<const Model> model, const std::string& where,
                                       const Progress& progress = {});
  /// The probe in a patient without a model, whose tissue is held and factorised first.
  /// @param scenario its materials and supports hold; its probe is the place around which the motions are and, with
  ///   in_contours, the reference
  /// Errors: those of hold_tissue() and PatientProbe::prepare().
  static Result<PressingProbe> prepare(const Scenario& scenario, TetMesh mesh, const std::string& where,
                                       const Progress& progress = {});

  /// Presses where the stepper holds the probe, and adds its displacement to a moment that has none of it yet: to the
  /// nodes, and to needles, tracks and seeds at the material points where they are.
  /// @param moment of this patient, whose mesh has the same nodes
  ProbePress press(const ProbeSettings& settings, Moment& moment);

  [[nodiscard]] PatientProbe& probe() { return probe_; }

 private:
  PressingProbe(std::shared_ptr<const void> patient, const Locator& locator, PatientProbe probe)
      : patient_(std::move(patient)), locator_(&locator), probe_(std::move(probe)) {}

  std::shared_ptr<const void> patient_;  ///< owner of the objects to which the other members refer
  const Locator* locator_;
  PatientProbe probe_;
};

}  // namespace stylet
