// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/vtk_messages.hpp"

#include <vtkLogger.h>

namespace stylet::detail {

vtkStandardNewMacro(VtkMessages);

vtkSmartPointer<VtkMessages> VtkMessages::install() {
  auto window = vtkSmartPointer<VtkMessages>::New();
  vtkOutputWindow::SetInstance(window);
  return window;
}

void silence_vtk() {
  static const bool is_silent = [] {  // once: VTK has no lock for either
    VtkMessages::install();
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    return true;
  }();
  (void)is_silent;
}

}  // namespace stylet::detail
