// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>

namespace stylet::detail {

/// Collects the messages that VTK would print. VTK reports errors only as text, and a reader that failed often returns
/// a part of the data.
class VtkMessages : public vtkOutputWindow {
 public:
  static VtkMessages* New();
  vtkTypeMacro(VtkMessages, vtkOutputWindow);

  /// Replaces VTK's own output window for the rest of the process, which reads one file.
  static vtkSmartPointer<VtkMessages> install();

  void DisplayErrorText(const char* text) override;
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  void DisplayText(const char*) override {}

  [[nodiscard]] bool failed() const { return !first_error_.empty(); }
  /// The text of the first error in one line, without source file and object address.
  [[nodiscard]] const std::string& first_error() const { return first_error_; }

 private:
  std::string first_error_;
};

}  // namespace stylet::detail
