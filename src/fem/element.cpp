// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/element.hpp"

namespace stylet {

const char* to_string(Element element) {
  switch (element) {
    case Element::p1:
      return "p1";
    case Element::nodal_pressure:
      return "nodal-pressure";
    case Element::p2:
      return "p2";
  }
  return "unknown";
}

std::optional<Element> element_named(std::string_view name) {
  for (const Element element : {Element::p1, Element::nodal_pressure, Element::p2}) {
    if (name == to_string(element)) return element;
  }
  return std::nullopt;
}

}  // namespace stylet
