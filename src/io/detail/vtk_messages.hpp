// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>

namespace stylet::detail {

/// Collects what VTK would print. VTK reports errors as text only: a reader that failed often returns half of its data.
class VtkMessages : public vtkOutputWindow {
 public:
  static VtkMessages* New();
  vtkTypeMacro(VtkMessages, vtkOutputWindow);

  /// Takes the place of VTK's own window for the rest of the process (a child process that reads one file).
  static vtkSmartPointer<VtkMessages> install();

  void DisplayErrorText(const char* text) override;
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  void DisplayText(const char*) override {}

  [[nodiscard]] bool failed() const { return !first_error_.empty(); }
  /// The first error's own words, one line, without source file and object address.
  [[nodiscard]] const std::string& first_error() const { return first_error_; }

 private:
  std::string first_error_;
};

}  // namespace stylet::detail
