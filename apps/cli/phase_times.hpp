// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::cli {

/// The processor time of the phases of a command, as they are reported as progress: of all threads of this program,
/// without the programs that read files for it. A phase lasts until another one is reported; phases with one name are
/// one.
class PhaseTimes {
 public:
  void enter(std::string_view phase);
  /// A line for each phase in the order in which they began, and one for all.
  [[nodiscard]] std::string table();

 private:
  struct Phase {
    std::string name;
    double seconds = 0.0;
  };
  void end_present();

  std::mutex mutex_;  ///< guards the members below
  std::vector<Phase> phases_{{"before the first phase"}};
  std::size_t present_ = 0;
  double since_s_ = 0.0;  ///< processor time of the program when the present phase began
};

}  // namespace stylet::cli
