// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/vtk_messages.hpp"

#include "detail/text.hpp"

namespace stylet::detail {

vtkStandardNewMacro(VtkMessages);

vtkSmartPointer<VtkMessages> VtkMessages::install() {
  auto window = vtkSmartPointer<VtkMessages>::New();
  vtkOutputWindow::SetInstance(window);
  return window;
}

void VtkMessages::DisplayErrorText(const char* text) {
  if (failed() || text == nullptr) return;
  // Format of a message: "ERROR: In file.cxx, line 12\nvtkClass (0x5581): words\n\n"
  std::string words(text);
  if (const auto end = words.find("): "); end != std::string::npos) words.erase(0, end + 3);
  words = trimmed(words);
  for (char& c : words) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  first_error_ = words.empty() ? "no reason given" : words;
}

}  // namespace stylet::detail
