// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"
#include "stylet/stylet_rt.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace stylet::rt {

/// Who uses what the simulations of a model share: any number that read it, or one that changes it. Nobody waits; a
/// call that comes at the wrong moment is told so.
class Gate {
 public:
  [[nodiscard]] bool enter() noexcept {
    if (state_.fetch_add(1, std::memory_order_acquire) >= 0) return true;
    leave();
    return false;
  }
  void leave() noexcept { state_.fetch_sub(1, std::memory_order_release); }

  [[nodiscard]] bool close() noexcept {
    std::int32_t nobody = 0;
    return state_.compare_exchange_strong(nobody, kClosed, std::memory_order_acquire, std::memory_order_relaxed);
  }
  void open() noexcept { state_.fetch_sub(kClosed, std::memory_order_release); }

 private:
  static constexpr std::int32_t kClosed = INT32_MIN / 2;  // readers that knock meanwhile do not make it positive
  std::atomic<std::int32_t> state_{0};
};

/// A reader's stay behind the gate.
class Reading {
 public:
  explicit Reading(Gate& gate) noexcept : gate_(gate), inside_(gate.enter()) {}
  ~Reading() {
    if (inside_) gate_.leave();
  }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  explicit operator bool() const noexcept { return inside_; }

 private:
  Gate& gate_;
  bool inside_;
};

/// The one that changes.
class Changing {
 public:
  explicit Changing(Gate& gate) noexcept : gate_(gate), inside_(gate.close()) {}
  ~Changing() {
    if (inside_) gate_.open();
  }
  Changing(const Changing&) = delete;
  Changing& operator=(const Changing&) = delete;
  explicit operator bool() const noexcept { return inside_; }

 private:
  Gate& gate_;
  bool inside_;
};

/// A model and the gate of its simulations; goes with the last that holds it.
struct SharedModel {
  explicit SharedModel(std::shared_ptr<const Model> model_) : model(std::move(model_)) {}
  std::shared_ptr<const Model> model;
  Gate gate;
};

}  // namespace stylet::rt

struct stylet_rt_model {
  std::shared_ptr<stylet::rt::SharedModel> shared;
};

struct stylet_rt_sim {
  stylet_rt_sim(std::shared_ptr<stylet::rt::SharedModel> model, std::uint32_t flags_);

  std::shared_ptr<stylet::rt::SharedModel> shared;
  stylet::Simulation simulation;
  std::uint32_t flags = 0;  ///< of stylet_rt_options
  std::size_t insertion = 0;
  std::vector<stylet::ContactState> contacts;  ///< room
};

namespace stylet::rt {

/// A handle for a model that is there already.
stylet_rt_model* make_handle(std::shared_ptr<const Model> model);

}  // namespace stylet::rt
