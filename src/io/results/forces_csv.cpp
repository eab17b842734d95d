// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces_csv.hpp"

#include "record/csv.hpp"
#include "record/run_columns.hpp"

namespace stylet::results {

std::string forces_csv(std::span<const Step> steps) { return record::csv_of(steps); }

}  // namespace stylet::results
