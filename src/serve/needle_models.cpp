// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_models.hpp"

#include "stylet/core/survive.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <utility>

namespace stylet::serve {

namespace {

constexpr int kNiceCompiling = 10;  // lower priority than the loop, the pictures and a browser on this machine
constexpr std::size_t kKept = 2;    // the present needle and the next one

struct NotNeeded {};

}  // namespace

NeedleModels::NeedleModels(const std::shared_ptr<const Model>& like, std::vector<InsertionPlan> plans,
                           std::vector<std::string> names)
    : needles_(*like),
      plans_(std::move(plans)),
      names_(std::move(names)),
      ready_(plans_.size()),
      failed_(plans_.size(), false),
      thread_([this] { run(); }) {}

NeedleModels::~NeedleModels() {
  give_up();
  thread_.join();
}

void NeedleModels::give_up() {
  {
    const std::scoped_lock lock(mutex_);
    given_up_ = true;
  }
  woken_.notify_all();
}

void NeedleModels::begin_after(std::size_t needle) {
  {
    const std::scoped_lock lock(mutex_);
    begins_ = true;
    current_ = needle;
    forget_others();
  }
  woken_.notify_all();
}

void NeedleModels::keep(std::size_t needle, Ready ready) {
  const std::scoped_lock lock(mutex_);
  ready_[needle] = std::move(ready);
  changed_ = true;
  current_ = needle;
  forget_others();
}

std::optional<NeedleModels::Ready> NeedleModels::find(std::size_t needle) {
  const std::scoped_lock lock(mutex_);
  return ready_[needle];
}

std::optional<std::vector<bool>> NeedleModels::news() {
  const std::scoped_lock lock(mutex_);
  if (!std::exchange(changed_, false)) return std::nullopt;
  std::vector<bool> all;
  for (const auto& ready : ready_) all.push_back(ready.has_value());
  return all;
}

/// The needle to compile next; waits until there is one. Empty when the thread has to end.
std::optional<std::size_t> NeedleModels::next() {
  std::unique_lock lock(mutex_);
  while (!given_up_) {
    for (std::size_t k = 0; k < std::min(kKept, plans_.size()) && begins_; ++k) {
      const std::size_t needle = (current_ + k) % plans_.size();
      if (!ready_[needle] && !failed_[needle]) return needle;
    }
    woken_.wait(lock);
  }
  return std::nullopt;
}

/// Forgets all models but those that are kept. The mutex is locked.
void NeedleModels::forget_others() {
  for (std::size_t needle = 0; needle < ready_.size(); ++needle) {
    const std::size_t later = (needle + ready_.size() - current_) % ready_.size();
    if (later < kKept || !ready_[needle]) continue;
    ready_[needle].reset();
    changed_ = true;
  }
}

/// The compiled needle; empty: it cannot be compiled, or is not needed any more.
std::optional<NeedleModels::Ready> NeedleModels::compiled(std::size_t needle) {
  const Progress progress = [this](std::string_view /*stage*/, double /*fraction*/) {
    if (given_up_) throw NotNeeded();
  };
  std::optional<Ready> made;
  try {
    const auto model = needles_.compile(plans_[needle], names_[needle], progress);
    if (!model) return made;
    made = Ready{*model, nullptr};
    if (auto field = DisplayField::prepare(*model, {}, progress)) made->field = std::move(*field);
  } catch (const NotNeeded&) {
    made.reset();
  } catch (const std::bad_alloc&) {  // the model is there, and its pictures do without
  }
  return made;
}

void NeedleModels::compile(std::size_t needle) {
  std::optional<Ready> made;
  survive(
      "the model of another needle", [&] { made = compiled(needle); }, [](const Error&) {});
  if (given_up_) return;
  const std::scoped_lock lock(mutex_);
  changed_ = true;
  if (!made) {
    failed_[needle] = true;  // choosing it says why
    return;
  }
  ready_[needle] = std::move(*made);
  forget_others();  // another needle may be the present one by now
}

void NeedleModels::run() {
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceCompiling);
  while (const auto needle = next()) {
    compile(*needle);
    malloc_trim(0);  // what forgotten models took goes back to the system
  }
  done_.store(true, std::memory_order_release);
}

}  // namespace stylet::serve
