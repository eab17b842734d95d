// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace stylet::cli {

/// Memory that this program can still take [GB]: the least of what the machine has available, what the control groups
/// of the program leave (cgroup v2) and what its limit of address space leaves. Empty if the system tells nothing.
std::optional<double> free_memory_GB();

}  // namespace stylet::cli
