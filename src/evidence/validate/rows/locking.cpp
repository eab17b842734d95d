// SPDX-License-Identifier: GPL-3.0-or-later
// Nearly incompressible tissue with elements that lock and with elements that do not.
#include "../rows.hpp"
#include "../solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

struct Case {
  Element element;
  const char* label;
  std::vector<int> cells;  ///< cells along an edge; the last mesh is judged
};

Finding locking(Context&) {
  const Material nearly{0.02, 0.499};
  const auto fine = need(press_block(nearly, 12, Element::p2));
  Finding finding{.value = 0.0};
  std::string each;
  for (const Case& chosen :
       {Case{Element::nodal_pressure, "averaged pressure (default)", {4, 6, 8, 12, 16}},
        Case{Element::p2, "quadratic", {2, 3, 4, 6, 8}}, Case{Element::p1, "linear", {4, 6, 8, 12, 16}}}) {
    Curve curve{.label = chosen.label};
    for (const int cells : chosen.cells) {
      const auto found = need(press_block(nearly, cells, chosen.element));
      curve.add(found.displacement_nodes, found.dent_mm);
    }
    const double off = 100.0 * (curve.y.back() / fine.dent_mm - 1.0);
    each += fmt::format("{}{} {:+.1f} %", each.empty() ? "" : ", ", chosen.label, off);
    if (chosen.element != Element::p1) finding.value = worse(finding.value, std::abs(off));
    finding.plot.curves.push_back(std::move(curve));
  }
  Curve reference{.label = "fine mesh", .kind = Curve::Kind::reference};
  for (const double x : {finding.plot.curves.front().x.front(), finding.plot.curves.front().x.back()}) {
    reference.add(x, fine.dent_mm);
  }
  finding.plot.curves.push_back(std::move(reference));
  finding.plot.x_label = "displacement nodes";
  finding.plot.y_label = "dent [mm]";
  finding.plot.log_x = true;
  finding.note = fmt::format(
      "A cube of 60 mm with ν = 0.499 stands on its floor under a smooth pressure. Difference of the dent with about "
      "4,900 displacement nodes from the dent of quadratic tetrahedra with three times as many: {}. The worse of the "
      "two kinds of elements that do not lock counts. The reference is one of them on a finer mesh; the other shares "
      "no assumption with it.",
      each);
  finding.why_missed = "The mesh is too coarse, or the reference itself is not fine enough.";
  return finding;
}

}  // namespace

std::vector<RowSpec> locking_rows() {
  return {{"locking", Group::analysis, "Nearly incompressible tissue has the correct softness",
           "a fine mesh of quadratic tetrahedra", "%", Accepted::at_most(2.0), false, locking}};
}

}  // namespace stylet::validate
