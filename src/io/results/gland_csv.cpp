// SPDX-License-Identifier: GPL-3.0-or-later
#include "gland_csv.hpp"

#include "record/csv.hpp"
#include "record/run_columns.hpp"

namespace stylet::results {

std::string gland_csv(std::span<const GlandStep> path) { return record::csv_of(path); }

}  // namespace stylet::results
