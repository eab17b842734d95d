// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "other_needles.hpp"
#include "stylet/sim/display_field.hpp"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace stylet::serve {

/// Compiles the model of the needle that follows the present one of a plan, in a thread of low priority, while the
/// present one moves: so the next needle of the plan is there at once. With the model it prepares the displacement
/// field of the pictures. The models of the present needle and of the next one are kept, and no others: a model of
/// 3,000 nodes takes about 100 MB, and a session of many needles is to take no more memory than one of two.
class NeedleModels {
 public:
  /// A compiled needle.
  struct Ready {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const DisplayField> field;  ///< null: there was too little memory for it
  };

  /// @param like a model of the same patient with any needle: its scenario, mesh and own parts are used
  /// @param plans (n) insertions of the needles @param names (n) for messages
  NeedleModels(const std::shared_ptr<const Model>& like, std::vector<InsertionPlan> plans,
               std::vector<std::string> names);
  ~NeedleModels();  ///< calls give_up() and waits for the thread to end
  NeedleModels(const NeedleModels&) = delete;
  NeedleModels& operator=(const NeedleModels&) = delete;

  /// Starts to work, or continues with the needle that follows this one, the present one.
  void begin_after(std::size_t needle);
  /// Keeps the model of a needle that is now the present one.
  void keep(std::size_t needle, Ready ready);
  /// The model of a needle; empty if it is not compiled.
  [[nodiscard]] std::optional<Ready> find(std::size_t needle);
  /// Which needles are compiled (n); empty if this has not changed since the last call.
  [[nodiscard]] std::optional<std::vector<bool>> news();

  /// Makes the thread end at its next report of progress.
  void give_up();
  /// Whether the thread has ended.
  [[nodiscard]] bool done() const { return done_.load(std::memory_order_acquire); }

 private:
  void run();
  [[nodiscard]] std::optional<std::size_t> next();
  void compile(std::size_t needle);
  void forget_others();
  [[nodiscard]] std::optional<Ready> compiled(std::size_t needle);

  OtherNeedles needles_;
  std::vector<InsertionPlan> plans_;
  std::vector<std::string> names_;
  std::atomic<bool> given_up_ = false;
  std::atomic<bool> done_ = false;

  std::mutex mutex_;  ///< guards the members below
  std::condition_variable woken_;
  std::vector<std::optional<Ready>> ready_;
  std::vector<bool> failed_;
  bool begins_ = false;
  std::size_t current_ = 0;
  bool changed_ = false;
  std::thread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
