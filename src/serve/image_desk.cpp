// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_desk.hpp"

#include "image_maker.hpp"
#include "tracked_probe.hpp"

#include "stylet/realtime/steppable.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <variant>

namespace stylet::serve {

namespace {

constexpr std::array<const char*, 4> kShownImages{"none", "transverse", "sagittal", "xray"};
constexpr auto kImageEvery = std::chrono::milliseconds(40);  // a picture takes less; the rest is left to the loop

/// The state of the loop that a picture needs.
struct LoopState {
  double time_s = 0.0;
  std::vector<TissueForce> forces;
  ShownNeedle needle;
  std::vector<ShownSeed> seeds;
};

bool is_of_pictures(std::string_view key) {
  return key.starts_with("probe.") || key.starts_with("ultrasound.") || key.starts_with("fluoroscopy.");
}

bool has_same_tables(const Scenario& a, const Scenario& b) {
  return a.probe == b.probe && a.ultrasound == b.ultrasound && a.fluoroscopy == b.fluoroscopy;
}

/// Takes the tables of pictures over from another scenario.
void take_tables(Scenario& to, const Scenario& from) {
  to.probe = from.probe;
  to.ultrasound = from.ultrasound;
  to.fluoroscopy = from.fluoroscopy;
}

}  // namespace

const char* to_string(ShownImage shown) { return kShownImages.at(static_cast<std::size_t>(shown)); }

std::optional<ShownImage> shown_image(std::string_view name) {
  const auto found = std::find(kShownImages.begin(), kShownImages.end(), name);
  if (found == kShownImages.end()) return std::nullopt;
  return static_cast<ShownImage>(found - kShownImages.begin());
}

struct ImageDesk::Parts {
  Parts() {
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  std::mutex mutex;
  std::condition_variable_any wake;
  // Guarded by the mutex.
  std::optional<ImageSubject> patient;  ///< taken by the thread
  Scenario tables;                      ///< as set by the pages; in a replay with the recorded place of the probe
  bool is_probe_moved = false;          ///< by a page, during a replay
  ShownImage shown = ShownImage::none;
  bool is_serving = false;  ///< a companion wants pictures
  bool is_changed = false;  ///< the tables or the kind of picture
  std::optional<Pose> tracked;
  bool is_moved = false;  ///< the tracked pose, or the patient, has changed
  std::variant<std::monostate, LoopState, Moment> newest;
  std::shared_ptr<const LiveImage> made;
  std::string problem, stage, probe_problem;

  // Used by the caller's thread.
  Scenario planned;  ///< of the open patient, as its file has it
  struct SetAside {
    Scenario tables, planned;
  };
  std::optional<SetAside> set_aside;  ///< of the live patient during a replay

  std::jthread thread;  ///< last member, so that it starts when the others exist

  void run(const std::stop_token& stop);
  [[nodiscard]] ShownImage kind() const;
  void follow_tracker(ImageMaker& maker);
};

/// The kind of picture to make. The mutex must be held.
ShownImage ImageDesk::Parts::kind() const {
  if (shown != ShownImage::none || !is_serving) return shown;
  return tables.ultrasound.array == UltrasoundArray::sagittal ? ShownImage::sagittal : ShownImage::transverse;
}

/// Moves the probe to a new tracked pose. The mutex must be held.
void ImageDesk::Parts::follow_tracker(ImageMaker& maker) {
  if (!std::exchange(is_moved, false) || !tracked) return;
  const auto seat = maker.seat();
  probe_problem = seat ? follow(*tracked, *seat, tables) : seat.error().what + ". " + seat.error().cure + ".";
}

/// Takes up what has come, makes a picture of it, and waits until the next one is due.
void ImageDesk::Parts::run(const std::stop_token& stop) {
  ImageMaker maker;
  while (!stop.stop_requested()) {
    std::variant<std::monostate, LoopState, Moment> state;
    {
      std::unique_lock lock(mutex);
      const bool go_on = wake.wait(lock, stop, [&] {
        return kind() != ShownImage::none && (is_changed || patient || !std::holds_alternative<std::monostate>(newest));
      });
      if (!go_on) return;
      if (patient) maker.open(*std::exchange(patient, std::nullopt));
      follow_tracker(maker);
      maker.set(kind(), tables, is_serving);
      is_changed = false;
      state = std::exchange(newest, std::monostate{});
    }
    const auto begun = std::chrono::steady_clock::now();
    const auto tell = [&](const std::string& what) {
      const std::lock_guard lock(mutex);
      stage = what;
    };
    if (const auto* loop = std::get_if<LoopState>(&state))
      maker.take(loop->time_s, loop->forces, loop->needle, loop->seeds);
    if (auto* moment = std::get_if<Moment>(&state)) maker.take(std::move(*moment));
    auto image = maker.make(tell);
    {
      const std::lock_guard lock(mutex);
      stage.clear();
      problem = image ? maker.remark() : image.error().what + ". " + image.error().cure + ".";
      made = image ? *std::move(image) : nullptr;
    }
    std::unique_lock lock(mutex);
    wake.wait_until(lock, stop, begun + kImageEvery, [] { return false; });
  }
}

ImageDesk::ImageDesk() : parts_(std::make_unique<Parts>()) {}
ImageDesk::~ImageDesk() = default;

void ImageDesk::open(ImageSubject patient) {
  const std::lock_guard lock(parts_->mutex);
  parts_->is_probe_moved = false;
  if (patient.is_recorded && !parts_->set_aside) parts_->set_aside = {parts_->tables, parts_->planned};
  if (!patient.is_recorded && parts_->set_aside) {
    parts_->tables = std::move(parts_->set_aside->tables);
    parts_->planned = std::move(parts_->set_aside->planned);
    parts_->set_aside.reset();
  }
  // Another needle in the same patient leaves the probe where it is.
  if (!has_same_tables(parts_->planned, patient.scenario)) take_tables(parts_->tables, patient.scenario);
  parts_->planned = patient.scenario;
  parts_->patient = std::move(patient);
  parts_->is_moved = true;
  parts_->newest = std::monostate{};
  parts_->wake.notify_all();
}

void ImageDesk::show(ShownImage shown) {
  shown_ = shown;
  const std::lock_guard lock(parts_->mutex);
  parts_->shown = shown;
  parts_->is_changed = true;
  if (!is_busy()) parts_->problem.clear();
  parts_->wake.notify_all();
}

void ImageDesk::serve(bool companion) {
  if (std::exchange(is_serving_, companion) == companion) return;
  const std::lock_guard lock(parts_->mutex);
  parts_->is_serving = companion;
  if (!is_busy()) parts_->problem.clear();
  parts_->is_changed = true;
  parts_->wake.notify_all();
}

void ImageDesk::track(const std::optional<Pose>& pose) {
  const std::lock_guard lock(parts_->mutex);
  std::optional<Pose>& tracked = parts_->tracked;
  const bool is_same = pose && tracked
                           ? pose->origin == tracked->origin && pose->rotation.coeffs() == tracked->rotation.coeffs()
                           : pose.has_value() == tracked.has_value();
  if (is_same) return;
  is_tracked_ = pose.has_value();
  tracked = pose;
  if (!tracked) parts_->probe_problem.clear();
  parts_->is_moved = parts_->is_changed = true;
  parts_->wake.notify_all();
}

Result<> ImageDesk::set(const std::string& key, double value) {
  if (!is_of_pictures(key))
    return input_error(key, "it is not a key of the pictures", "Set a key of [probe], [ultrasound] or [fluoroscopy]");
  const std::lock_guard lock(parts_->mutex);
  if (parts_->tracked && is_of_stepper(key))
    return input_error(key, "a tracker moves the probe", "Move the tracked probe, or disconnect the tracker");
  const ScenarioValue as_number{.type = ScenarioValue::Type::number, .number = value};
  if (auto done = set_scenario_key(parts_->tables, key, as_number, key); !done) return done;
  parts_->is_probe_moved = parts_->is_probe_moved || key.starts_with("probe.");
  parts_->is_changed = true;
  parts_->wake.notify_all();
  return Ok{};
}

void ImageDesk::take(const Snapshot& snapshot, std::vector<ShownSeed> seeds) {
  LoopState state;
  state.time_s = snapshot.step.time_s;
  state.forces.resize(Snapshot::kForces);
  state.forces.resize(tissue_forces(snapshot, state.forces).size());
  for (const Triple& point : snapshot.centreline) state.needle.centreline_mm.push_back(vec3(point));
  state.seeds = std::move(seeds);
  const std::lock_guard lock(parts_->mutex);
  parts_->newest = std::move(state);
  parts_->wake.notify_all();
}

void ImageDesk::take(Moment moment, const std::optional<ProbeSettings>& probe) {
  const std::lock_guard lock(parts_->mutex);
  if (probe && !parts_->is_probe_moved) parts_->tables.probe = *probe;
  parts_->newest = std::move(moment);
  parts_->wake.notify_all();
}

ProbeSettings ImageDesk::probe() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->tables.probe;
}

std::shared_ptr<const LiveImage> ImageDesk::news() {
  const std::lock_guard lock(parts_->mutex);
  return std::exchange(parts_->made, nullptr);
}

std::string ImageDesk::problem() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->problem;
}

std::string ImageDesk::stage() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->stage;
}

std::string ImageDesk::probe_problem() const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->probe_problem;
}

}  // namespace stylet::serve
