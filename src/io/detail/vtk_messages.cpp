// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/vtk_messages.hpp"

namespace stylet::detail {

vtkStandardNewMacro(VtkMessages);

vtkSmartPointer<VtkMessages> VtkMessages::install() {
  auto window = vtkSmartPointer<VtkMessages>::New();
  vtkOutputWindow::SetInstance(window);
  return window;
}

}  // namespace stylet::detail
