// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

namespace stylet {

/// What the tissue is computed with. docs/theory/tissue.md compares them.
enum class Element {
  p1,              ///< linear tetrahedra: constant strain; lock as Poisson's ratio approaches one half
  nodal_pressure,  ///< linear tetrahedra whose change of volume is averaged over the elements around each node
  p2               ///< quadratic tetrahedra: further displacement nodes in the middles of the edges
};

/// As scenarios name them: "p1", "nodal-pressure", "p2".
const char* to_string(Element element);
std::optional<Element> element_named(std::string_view name);

}  // namespace stylet
