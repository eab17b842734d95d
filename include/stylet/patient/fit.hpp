// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/input.hpp"
#include "stylet/mesher/mesher.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// The consequence of a finding about a patient.
enum class FitVerdict {
  note,    ///< the user should know it
  warn,    ///< something is probably wrong
  refuse,  ///< this is not a patient for this program, unless the user names the gland
};

/// A rule by which a patient is judged (docs/formats.md has the table with the reasons).
struct FitRule {
  const char* name;
  const char* bound;      ///< the expectation, in words
  FitVerdict if_guessed;  ///< for a gland that is a planning volume whose name does not say "prostate"
  FitVerdict if_named;    ///< for a gland that the file names
};

/// All rules, in the order in which they are applied.
std::span<const FitRule> fit_rules();

/// A rule that a patient breaks.
struct FitFinding {
  std::string rule;
  FitVerdict verdict = FitVerdict::note;
  std::string what;  ///< a part of a sentence, without a full stop
  std::string cure;  ///< a sentence without a full stop

  /// The finding as a message to the user who may go on.
  [[nodiscard]] std::string message() const;
};

/// Choices of the user by which a patient is judged.
struct FitOptions {
  /// Regions that the user assigns, and structures to leave out. Whoever assigns a structure to the gland insists on
  /// it: nothing is refused then, but warned of.
  MeshOptions names;
  double scale = 0.0;  ///< length of the unit of a mesh file [mm], as the user says; 0: as the file says
};

/// Judges whether the structures of a file are a patient for the simulation of prostate needles: the size of the gland,
/// its place among the organs and in the body, organs from elsewhere, axes that are flipped. A file without a gland
/// has no findings.
/// @param input contours, a mask or a mesh, in mm (LPS); surfaces are not judged
std::vector<FitFinding> judge_fit(const PatientInput& input, const FitOptions& options);

/// The error for a patient that is refused; empty if no finding refuses it.
std::optional<Error> refusal(std::span<const FitFinding> findings, const std::string& where);

}  // namespace stylet
