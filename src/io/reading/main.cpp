// SPDX-License-Identifier: GPL-3.0-or-later
// stylet-reader: parses files of unknown origin for stylet and for programs that use its library (reading/ask.hpp).
#include "reading/table.hpp"

int main() { return stylet::detail::run_reading_program(stylet::detail::all_tasks()); }
