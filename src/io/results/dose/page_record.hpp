// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_evaluation.hpp"

#include <string>

/// The parts of a page that make it a record: patient and plan, time and files of the computation, line for a
/// signature.
namespace stylet::results {

/// The name of a plan: its label, or else the name of its file.
std::string plan_name(const DosePlan& plan);

/// Patient, plan, time, program and files with their hashes, as HTML. What is not known is "–".
std::string record_of(const DoseEvaluation& evaluation);

/// CSS of the printed pages' margins: patient, plan and time above, program and page numbers below.
std::string printed_margins(const DoseEvaluation& evaluation);

}  // namespace stylet::results
