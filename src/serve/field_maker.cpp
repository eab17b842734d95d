// SPDX-License-Identifier: GPL-3.0-or-later
#include "field_maker.hpp"

#include "stylet/core/parallel.hpp"
#include "stylet/core/survive.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

namespace stylet::serve {

namespace {

constexpr int kNice = 10;        ///< lower priority than the loop, the pictures and a browser on this machine
constexpr double kStages = 2.0;  ///< stages of DisplayField::prepare(), for fraction()

struct GivenUp {};

}  // namespace

FieldMaker::FieldMaker(std::shared_ptr<const Model> model, std::chrono::duration<double> longest_wait)
    : thread_([this, model = std::move(model), longest_wait]() mutable {
        wait(longest_wait);
        make(std::move(model));
      }) {}

FieldMaker::~FieldMaker() { give_up(); }

void FieldMaker::begin() {
  {
    const std::lock_guard lock(mutex_);
    begins_ = true;
  }
  woken_.notify_all();
}

void FieldMaker::give_up() {
  given_up_ = true;
  begin();
}

void FieldMaker::wait(std::chrono::duration<double> longest) {
  std::unique_lock lock(mutex_);
  (void)woken_.wait_for(lock, longest, [this] { return begins_; });
}

void FieldMaker::prepare(std::shared_ptr<const Model> model) {
  const Progress progress = [this](std::string_view stage, double fraction) {
    if (given_up_) throw GivenUp();
    const bool first = stage == "display: choosing columns";
    fraction_.store((first ? fraction : 1.0 + fraction) / kStages, std::memory_order_relaxed);
  };
  try {
    if (given_up_) throw GivenUp();
    auto field = DisplayField::prepare(std::move(model), {}, progress);
    if (field) {
      made_ = std::move(*field);
    } else {
      problem_ = field.error().what;
    }
  } catch (const GivenUp&) {  // nobody needs the field
  }
}

void FieldMaker::make(std::shared_ptr<const Model> model) {
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
  survive(
      "the picture of the tissue's motion", [&] { prepare(std::move(model)); },
      [&](const Error& why) { problem_ = why.what; });
  seconds_ = work_seconds();
  done_.store(true, std::memory_order_release);
}

}  // namespace stylet::serve
