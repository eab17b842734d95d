// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shelf.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace stylet::serve {

/// What a recording is about.
struct CatalogueEntry {
  std::string name;
  std::string problem;             ///< why nothing else is known; empty: it is
  std::string of_case;             ///< name of the scenario
  std::string needle;              ///< of the plan of seeds; empty: there is no plan, or the needle is beside it
  double duration_s = 0.0;         ///< [s] simulated time
  bool has_ended = false;          ///< false: it goes on, or was interrupted
  std::optional<double> most_N{};  ///< [N] RecordingHead::most_N
  bool has_plan = false;           ///< of seeds
  std::size_t planned_seeds = 0;
  std::size_t seeds = 0;                ///< in the tissue at the end
  std::optional<double> d90_percent{};  ///< of them; empty where it was not computed
};

/// The recordings on the shelf with what they are about. It reads only those that are new or have changed since the
/// last call. May be used from any thread.
class Catalogue {
 public:
  explicit Catalogue(Shelf shelf) : shelf_(std::move(shelf)) {}
  /// All recordings, newest first.
  [[nodiscard]] std::vector<CatalogueEntry> list();

 private:
  struct Kept {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type written;
    CatalogueEntry entry;
  };
  Shelf shelf_;
  std::mutex mutex_;
  std::map<std::string, Kept> kept_;
};

}  // namespace stylet::serve
