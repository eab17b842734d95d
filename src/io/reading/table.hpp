// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "reading/program.hpp"

namespace stylet::detail {

/// Every task of `stylet-reader` with its parser.
TaskTable all_tasks();

}  // namespace stylet::detail
