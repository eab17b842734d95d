// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/rate_table.hpp"
#include "stylet/serve/implant_case.hpp"
#include "stylet/serve/implant_picture.hpp"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace stylet::serve {

/// Results of ImplantDose.
struct ImplantNews {
  std::optional<ImplantScore> planned;
  std::optional<ImplantScore> now;
  std::uint64_t version = 0;  ///< `now` is of the seeds with this number (set())
  std::shared_ptr<const LiveDose> grid;
  std::optional<Error> problem;  ///< the dose of the last seeds cannot be computed
  [[nodiscard]] bool is_any() const { return planned || now || grid; }
};

/// The dose of the seeds that have been dropped so far, computed anew in a thread of its own whenever they change:
/// first D90 and V100 of the target, then the goals and the grid. The dose of each sample is kept, so that a further
/// seed costs no more than the first.
///
/// At most kMostSamples of a structure are used, spread evenly; D90 then differs from that of all samples by less than
/// 0.5 % (test ImplantDose.*).
class ImplantDose {
 public:
  static constexpr std::size_t kMostSamples = 20'000;

  /// Errors: those of Tg43::create(); the case has no target.
  static Result<std::unique_ptr<ImplantDose>> open(std::shared_ptr<const ImplantCase> implant);
  ~ImplantDose();
  ImplantDose(const ImplantDose&) = delete;
  ImplantDose& operator=(const ImplantDose&) = delete;

  /// Sets the seeds, with their strength [U] as weight. Returns at once. @return number of these seeds, for News
  std::uint64_t set(std::vector<PlacedSource> seeds);

  using News = ImplantNews;
  /// The results that have been computed since the last call.
  [[nodiscard]] News news();

 private:
  /// Points with the dose of the seeds that were added to them.
  class Field;
  struct Structure;
  struct Wanted {
    std::vector<PlacedSource> seeds;
    std::chrono::steady_clock::time_point since;
    std::uint64_t version = 0;
  };

  ImplantDose(std::shared_ptr<const ImplantCase> implant, Tg43 tg43);
  void run(const std::stop_token& stop);
  void prepare();
  void fail(const Error& why);
  void compute_planned();
  void compute(const Wanted& wanted);
  [[nodiscard]] bool is_newest(const Wanted& wanted);
  [[nodiscard]] std::vector<JudgedGoal> judge(const std::vector<Structure>& structures) const;
  [[nodiscard]] ImplantScore score(const Structure& target, std::size_t seeds) const;

  std::shared_ptr<const ImplantCase> implant_;
  // Used by the thread only.
  RateTable table_;
  std::vector<Structure> structures_;  ///< the target first
  std::unique_ptr<Field> grid_;
  LiveDose empty_grid_;

  std::mutex mutex_;  ///< guards the members below
  std::condition_variable_any woken_;
  Wanted wanted_;
  News news_;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
