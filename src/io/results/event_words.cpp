// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/event_words.hpp"

#include "stylet/io/region_views.hpp"
#include "stylet/sim/scenario.hpp"

#include <cctype>
#include <utility>

namespace stylet::results {
namespace {

std::string the(const std::string& region) { return region.empty() ? "the tissue" : "the " + spoken_name(region); }

/// Whether a region lies within an organ, so that who enters it has not left the organ.
bool is_within_an_organ(const std::string& region) { return region == "urethra" || region.ends_with("lumen"); }

/// Whether who comes to a region from outside has gone through the skin.
bool lies_under_the_skin(const std::string& region) { return is_surrounding(region) || region == "skin"; }

/// The tip goes from one region of the patient to another. @param from empty: not known
/// @param outermost the region in which the tip entered the patient, which surrounds all others on its way
std::string said_crossing(const std::string& from, const std::string& to, const std::string& outermost) {
  const bool from_organ = !from.empty() && from != outermost && !is_surrounding(from);
  const bool away = from_organ && !is_within_an_organ(to);
  if (to == "body") return from.empty() ? "entered the tissue between the organs" : "left " + the(from);
  return away ? "left " + the(from) + " into " + the(to) : "entered " + the(to);
}

}  // namespace

std::string spoken_name(const std::string& region) {
  std::string text = readable_name(region);
  const bool initials = text.size() > 1 && std::isupper(static_cast<unsigned char>(text[1])) != 0;
  if (!text.empty() && !initials) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

/// The region that the tip leaves; "" outside of the patient. A needle that was out and comes in again may follow its
/// earlier track, of whose regions there are no events. It has not, if what it crosses is what it touched, and lies
/// before the end of that track.
std::string EventWords::left_by(const Event& event) const {
  if (!where_ || !where_->empty()) return where_.value_or("");
  if (!earlier_) return "";
  const bool touched = event.region == touched_;
  const bool before_its_end = earlier_->end == touched_ || event.depth_mm - touched_mm_ < earlier_->length_mm;
  return touched && before_its_end ? "" : earlier_->end;
}

std::string EventWords::crossing(const Event& event) {
  const std::string from = left_by(event);
  const bool from_outside = where_.has_value() && from.empty();
  where_ = event.region;
  crossed_mm_ = event.depth_mm;
  if (from_outside && lies_under_the_skin(event.region)) return "went through the skin";
  return said_crossing(from, event.region, touched_);
}

void EventWords::touch(const Event& event) {
  where_ = "";
  touched_ = event.region;
  touched_mm_ = event.depth_mm;
}

std::string EventWords::clause(const Event& event) {
  const std::optional<Event> before = std::exchange(puncture_, std::nullopt);
  switch (event.kind) {
    case EventKind::skin_contact:
      touch(event);
      return lies_under_the_skin(event.region) || event.region.empty() ? "touched the skin"
                                                                       : "touched " + the(event.region);
    case EventKind::puncture:
      puncture_ = event;
      return crossing(event);
    case EventKind::region_entered:
      if (before && before->region == event.region && before->time_s == event.time_s) return {};
      return crossing(event);
    case EventKind::retraction_start:
      return "began to be drawn back";
    case EventKind::slip_start:
      return "began to slip back";
    case EventKind::withdrawn:
      if (where_ && !where_->empty()) earlier_ = {*where_, crossed_mm_ - touched_mm_};
      where_ = "";
      return "came out of the patient";
    case EventKind::bone_contact:
      return event.region.empty() ? "met bone" : "met bone (" + spoken_name(event.region) + ")";
    case EventKind::exited:
      where_ = "";
      return "came out on the far side";
    case EventKind::re_entered:
      touch(event);
      return "touched tissue again";
    case EventKind::grazed:
      return "slid along the surface";
  }
  return to_string(event.kind);
}

std::string EventWords::label(const Event& event) {
  std::string text = clause(event);
  // What the hand does is short, since it stands beside many other labels.
  if (event.kind == EventKind::retraction_start) return "Drawn back";
  if (event.kind == EventKind::slip_start) return "Slips";
  if (event.kind == EventKind::withdrawn) return "Out of the patient";
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::vector<std::string> event_labels(std::span<const Event> events) {
  EventWords words;
  std::vector<std::string> labels;
  labels.reserve(events.size());
  for (const Event& event : events) labels.push_back(words.label(event));
  return labels;
}

}  // namespace stylet::results
