// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_models.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <utility>

namespace stylet::serve {

namespace {

constexpr int kNiceCompiling = 10;  // lower priority than the loop, the pictures and a browser on this machine

struct NotNeeded {};

double megabytes_of(const NeedleModels::Ready& ready) {
  constexpr double per_number = 8e-6;
  const double nodes = ready.model->mesh().node_count();
  const double stored = ready.model->store() ? static_cast<double>(ready.model->store()->stored().size()) : 0.0;
  // Mesh, factor of the stiffness and near field together, measured on some thousand nodes.
  constexpr double numbers_per_dof = 1000.0;
  return per_number * (9.0 * stored * stored + 3.0 * nodes * numbers_per_dof) +
         (ready.field ? ready.field->statistics().megabytes : 0.0);
}

double megabytes_for_models() {
  const double machine =
      1e-6 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::min(NeedleModels::kMostMegabytes, 0.25 * machine);
}

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
    is_full_ = false;
  }
  woken_.notify_all();
}

void NeedleModels::keep(std::size_t needle, Ready ready) {
  const std::scoped_lock lock(mutex_);
  ready_[needle] = std::move(ready);
  changed_ = true;
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

/// How many needles later a needle is needed.
std::size_t NeedleModels::distance(std::size_t needle) const {
  return (needle + plans_.size() - current_) % plans_.size();
}

/// The needle to compile next; waits until there is one. Empty when the thread has to end.
std::optional<std::size_t> NeedleModels::next() {
  std::unique_lock lock(mutex_);
  while (!given_up_) {
    for (std::size_t k = 0; k < plans_.size() && begins_ && !is_full_; ++k) {
      const std::size_t needle = (current_ + k) % plans_.size();
      if (!ready_[needle] && !failed_[needle]) return needle;
    }
    woken_.wait(lock);
  }
  return std::nullopt;
}

/// Gives up the models that will be needed last, while all together take too much memory. The mutex is locked.
void NeedleModels::drop_farthest(std::size_t but) {
  double sum = 0.0;
  for (const auto& ready : ready_) sum += ready ? megabytes_of(*ready) : 0.0;
  while (sum > megabytes_for_models()) {
    std::size_t farthest = current_;
    for (std::size_t k = 0; k < ready_.size(); ++k) {
      if (ready_[k] && distance(k) > distance(farthest)) farthest = k;
    }
    if (farthest == current_) return;
    sum -= megabytes_of(*ready_[farthest]);
    ready_[farthest].reset();
    if (farthest == but || distance(farthest) >= distance(but)) is_full_ = true;
  }
}

void NeedleModels::compile(std::size_t needle) {
  const Progress progress = [this](std::string_view /*stage*/, double /*fraction*/) {
    if (given_up_) throw NotNeeded();
  };
  std::optional<Ready> made;
  try {
    const auto model = needles_.compile(plans_[needle], names_[needle], progress);
    if (model) {
      made = Ready{*model, nullptr};
      if (auto field = DisplayField::prepare(*model, {}, progress)) made->field = std::move(*field);
    }
  } catch (const NotNeeded&) {
    return;
  } catch (const std::bad_alloc&) {
    if (made) made->field.reset();
  }
  const std::scoped_lock lock(mutex_);
  changed_ = true;
  if (!made) {
    failed_[needle] = true;  // choosing it says why
    return;
  }
  ready_[needle] = std::move(*made);
  drop_farthest(needle);
}

void NeedleModels::run() {
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceCompiling);
  while (const auto needle = next()) compile(*needle);
  done_.store(true, std::memory_order_release);
}

}  // namespace stylet::serve
