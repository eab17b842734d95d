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

/// Compiles the models of a plan's needles in a thread of low priority, while the needle moves: first the needle that
/// follows the present one, then the others in their order. So the next needle of the plan is there at once. For each
/// it also prepares the displacement field of the pictures.
///
/// As many models are kept as fit into a quarter of the machine's memory and kMostMegabytes; a model of 3,000 nodes
/// takes about 100 MB. Those that will be needed last are given up first.
class NeedleModels {
 public:
  static constexpr double kMostMegabytes = 3000.0;

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

  /// Starts to work, or continues with the needles that follow this one.
  void begin_after(std::size_t needle);
  /// Keeps a model that was compiled elsewhere.
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
  void drop_farthest(std::size_t but);
  [[nodiscard]] std::size_t distance(std::size_t needle) const;

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
  bool is_full_ = false;  ///< no further model fits into the memory until another needle is the present one
  bool changed_ = false;
  std::thread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
