// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_desk.hpp"

#include "image_maker.hpp"

#include "stylet/core/survive.hpp"
#include "stylet/realtime/steppable.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace stylet::serve {

namespace {

constexpr std::array<const char*, 4> kShownImages{"none", "transverse", "sagittal", "xray"};
constexpr auto kImageEvery = std::chrono::milliseconds(40);  // a picture takes less; the rest is left to the loop
constexpr auto kImageAfterFailure = std::chrono::milliseconds(1000);

}  // namespace

const char* to_string(ShownImage shown) { return kShownImages.at(static_cast<std::size_t>(shown)); }

std::optional<ShownImage> shown_image(std::string_view name) {
  const auto found = std::find(kShownImages.begin(), kShownImages.end(), name);
  if (found == kShownImages.end()) return std::nullopt;
  return static_cast<ShownImage>(found - kShownImages.begin());
}

LoopState loop_state(const Snapshot& snapshot) {
  LoopState state;
  state.time_s = snapshot.step.time_s;
  state.forces.resize(Snapshot::kForces);
  state.forces.resize(tissue_forces(snapshot, state.forces).size());
  const auto add = [&state](std::span<const Triple> shape) {
    std::ranges::transform(shape, std::back_inserter(state.needles_mm.emplace_back()),
                           [](const Triple& point) { return vec3(point); });
  };
  add(snapshot.centreline);
  for (int k = 0; k < snapshot.resting_count; ++k) add(snapshot.resting[static_cast<std::size_t>(k)]);
  return state;
}

/// The kind of picture to make. The mutex must be held.
ShownImage ImageDesk::kind() const {
  if (shown_ != ShownImage::none || !is_serving_) return shown_;
  return tables_.tables().ultrasound.array == UltrasoundArray::sagittal ? ShownImage::sagittal : ShownImage::transverse;
}

/// Makes a picture of what has come.
void ImageDesk::make_picture(ImageMaker& maker, std::variant<std::monostate, LoopState, Moment> state) {
  const auto tell = [&](const std::string& what) {
    const std::lock_guard lock(mutex_);
    stage_ = what;
  };
  if (const auto* loop = std::get_if<LoopState>(&state))
    maker.take(loop->time_s, loop->forces, loop->needles_mm, loop->seeds);
  if (auto* moment = std::get_if<Moment>(&state)) maker.take(std::move(*moment));
  auto image = maker.make(tell);
  const std::lock_guard lock(mutex_);
  problem_ = image ? maker.remark() : image.error().what + ". " + image.error().cure + ".";
  made_ = image ? *std::move(image) : nullptr;
}

/// Waits for something to make a picture of, and makes it. @return when that began; empty if the thread is to stop
std::optional<ImageDesk::Clock::time_point> ImageDesk::take_turn(ImageMaker& maker, std::optional<ImageSubject>& opened,
                                                                 const std::stop_token& stop) {
  std::variant<std::monostate, LoopState, Moment> state;
  {
    std::unique_lock lock(mutex_);
    const bool go_on = wake_.wait(lock, stop, [&] {
      return kind() != ShownImage::none &&
             (is_changed_ || patient_ || !std::holds_alternative<std::monostate>(newest_));
    });
    if (!go_on) return std::nullopt;
    if (patient_) {
      opened = std::exchange(patient_, std::nullopt);
      maker.open(*opened);
    }
    if (tables_.is_moved()) tables_.follow(maker.seat());
    maker.set(kind(), tables_.tables(), is_serving_);
    is_changed_ = false;
    state = std::exchange(newest_, std::monostate{});
  }
  const auto begun = Clock::now();
  make_picture(maker, std::move(state));
  return begun;
}

void ImageDesk::run(const std::stop_token& stop) {
  ImageMaker maker;
  std::optional<ImageSubject> opened;
  while (!stop.stop_requested()) {
    std::optional<Clock::time_point> begun = Clock::now();
    const bool is_made = survive(
        "the image", [&] { begun = take_turn(maker, opened, stop); },
        [&](const Error& why) {
          const std::lock_guard lock(mutex_);
          problem_ = why.what + ". " + why.cure + ".";
          made_ = nullptr;
          if (!patient_) patient_ = opened;  // what was prepared for it may be incomplete
        });
    if (!begun) return;
    std::unique_lock lock(mutex_);
    stage_.clear();
    wake_.wait_until(lock, stop, *begun + (is_made ? kImageEvery : kImageAfterFailure), [] { return false; });
  }
}

ImageDesk::ImageDesk() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

/// Changes something that the thread takes up.
void ImageDesk::change(const std::function<void()>& what) {
  const std::lock_guard lock(mutex_);
  what();
  wake_.notify_all();
}

void ImageDesk::open(ImageSubject patient) {
  change([&] {
    tables_.open(patient.scenario, patient.is_recorded);
    patient_ = std::move(patient);
    newest_ = std::monostate{};
  });
}

void ImageDesk::show(ShownImage shown) {
  change([&] {
    shown_ = shown;
    is_changed_ = true;
    if (!is_busy()) problem_.clear();
  });
}

void ImageDesk::serve(bool companion) {
  if (is_serving_ == companion) return;
  change([&] {
    is_serving_ = companion;
    is_changed_ = true;
    if (!is_busy()) problem_.clear();
  });
}

void ImageDesk::track(const std::optional<Pose>& pose) {
  change([&] { is_changed_ = tables_.track(pose) || is_changed_; });
}

Result<> ImageDesk::set(const std::string& key, double value) {
  Result<> done = Ok{};
  change([&] {
    done = tables_.set(key, value);
    is_changed_ = done.ok() || is_changed_;
  });
  return done;
}

void ImageDesk::take(LoopState state) {
  change([&] { newest_ = std::move(state); });
}

void ImageDesk::take(Moment moment, const std::optional<ProbeSettings>& probe) {
  change([&] {
    if (probe) tables_.take_recorded(*probe);
    newest_ = std::move(moment);
  });
}

ProbeSettings ImageDesk::probe() const {
  const std::lock_guard lock(mutex_);
  return tables_.tables().probe;
}

std::shared_ptr<const LiveImage> ImageDesk::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(made_, nullptr);
}

ImageDesk::Report ImageDesk::report() const {
  const std::lock_guard lock(mutex_);
  return {problem_, stage_, tables_.probe_problem()};
}

}  // namespace stylet::serve
