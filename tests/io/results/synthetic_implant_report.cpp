// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the result folder of an invented implant, for work on the report of stylet implant:
//   synthetic_implant_report OUT/
#include "synthetic_implant.hpp"

#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: synthetic_implant_report OUT/\n");
    return 2;
  }
  const auto done = stylet::write_implant_results(stylet::testing::synthetic_implant(1.0, 0.5), argv[1]);
  if (!done) std::fprintf(stderr, "%s\n", done.error().message().c_str());
  return done ? 0 : 1;
}
