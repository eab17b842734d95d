// SPDX-License-Identifier: GPL-3.0-or-later
#include "discretisation.hpp"

#include "linear_tetrahedra.hpp"
#include "nodal_pressure.hpp"
#include "quadratic_tetrahedra.hpp"

namespace stylet::detail {

std::unique_ptr<Discretisation> Discretisation::make(Element element, const TetMesh& mesh) {
  switch (element) {
    case Element::p1:
      break;
    case Element::nodal_pressure:
      return std::make_unique<NodalPressure>(mesh);
    case Element::p2:
      return std::make_unique<QuadraticTetrahedra>(mesh);
  }
  return std::make_unique<LinearTetrahedra>(mesh);
}

}  // namespace stylet::detail
