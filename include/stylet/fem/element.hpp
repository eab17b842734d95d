// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

namespace stylet {

/// Kind of finite element of the tissue. docs/theory/tissue.md compares them.
enum class Element {
  p1,              ///< linear tetrahedra: constant strain; they lock as Poisson's ratio approaches one half
  nodal_pressure,  ///< linear tetrahedra whose change of volume is averaged over the elements around each node
  p2               ///< quadratic tetrahedra: additional displacement nodes in the middles of the edges
};

/// Name of a kind of element in scenarios: "p1", "nodal-pressure" or "p2".
const char* to_string(Element element);
std::optional<Element> element_named(std::string_view name);

}  // namespace stylet
