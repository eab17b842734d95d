// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_tables.hpp"

#include "tracked_probe.hpp"

#include <tuple>

namespace stylet::serve {

namespace {

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

void ImageTables::open(const Scenario& scenario, bool is_recorded) {
  is_probe_moved_ = false;
  if (is_recorded && !set_aside_) set_aside_ = {tables_, planned_};
  if (!is_recorded && set_aside_) {
    std::tie(tables_, planned_) = *std::move(set_aside_);
    set_aside_.reset();
  }
  // Another needle in the same patient leaves the probe where it is.
  if (!has_same_tables(planned_, scenario)) take_tables(tables_, scenario);
  planned_ = scenario;
  is_moved_ = true;
}

Result<> ImageTables::set(const std::string& key, double value) {
  if (!is_of_pictures(key))
    return input_error(key, "it is not a key of the pictures", "Set a key of [probe], [ultrasound] or [fluoroscopy]");
  if (tracked_ && is_of_stepper(key))
    return input_error(key, "a tracker moves the probe", "Move the tracked probe, or disconnect the tracker");
  const ScenarioValue as_number{.type = ScenarioValue::Type::number, .number = value};
  if (auto done = set_scenario_key(tables_, key, as_number, key); !done) return done;
  is_probe_moved_ = is_probe_moved_ || key.starts_with("probe.");
  return Ok{};
}

bool ImageTables::track(const std::optional<Pose>& pose) {
  const bool is_same = pose && tracked_
                           ? pose->origin == tracked_->origin && pose->rotation.coeffs() == tracked_->rotation.coeffs()
                           : pose.has_value() == tracked_.has_value();
  if (is_same) return false;
  tracked_ = pose;
  if (!tracked_) probe_problem_.clear();
  is_moved_ = true;
  return true;
}

void ImageTables::take_recorded(const ProbeSettings& probe) {
  if (!is_probe_moved_) tables_.probe = probe;
}

void ImageTables::follow(const Result<ProbeSeat>& seat) {
  is_moved_ = false;
  probe_problem_ = seat ? serve::follow(*tracked_, *seat, tables_) : seat.error().what + ". " + seat.error().cure + ".";
}

}  // namespace stylet::serve
