// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace stylet::detail {

/// Takes the messages that VTK would print. VTK reports errors only as text, and a reader that failed often returns a
/// part of the data. The text itself is that of a library: readers say in their own words what is wrong with the file.
class VtkMessages : public vtkOutputWindow {
 public:
  static VtkMessages* New();
  vtkTypeMacro(VtkMessages, vtkOutputWindow);

  /// Replaces VTK's own output window for the rest of the process, which reads one file.
  static vtkSmartPointer<VtkMessages> install();

  void DisplayErrorText(const char*) override { failed_ = true; }
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  void DisplayText(const char*) override {}

  [[nodiscard]] bool failed() const { return failed_; }

 private:
  bool failed_ = false;
};

/// From here on VTK says nothing on the terminal. Its writers return whether they failed.
void silence_vtk();

}  // namespace stylet::detail
