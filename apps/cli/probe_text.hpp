// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"
#include "stylet/patient/imaged_patient.hpp"

namespace stylet::cli {

/// Says where the probe of a picture is, its force, and how it moves the gland; nothing if no probe presses.
/// @return the same as JSON; null if no probe presses
Json say_probe(const ImagedPatient& patient, Console& console);

}  // namespace stylet::cli
