// SPDX-License-Identifier: GPL-3.0-or-later
#include "hall.hpp"

#include <boost/asio/post.hpp>

namespace stylet::serve {

namespace {

constexpr std::size_t kKeptEvents = 1000;

}  // namespace

/// A copy of the viewers, because sending may close a viewer and so remove it from the map.
void Hall::to_each(const std::function<void(Viewer&)>& send) const {
  for (const auto& [id, viewer] : std::map(viewers_)) send(*viewer);
}

/// Lets the watch of the holder take its turns.
void Hall::wait_turn() {
  turn_.expires_after(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(HolderWatch::kTurn_s)));
  turn_.async_wait([this](boost::system::error_code error) {
    if (error) return;
    watch_.watch(holding_.holder());
    if (watch_.turn()) stop_silent_hand();
    wait_turn();
  });
}

/// The needle stays where it is, since its holder could not see where it goes.
void Hall::stop_silent_hand() {
  session_.let_go();
  say_status();
}

void Hall::close() {
  turn_.cancel();
  to_each([](Viewer& viewer) { viewer.close(); });
}

/// Keeps a message for newcomers.
void Hall::keep(const Parcel& parcel) {
  if (parcel.kind == wire::Kind::scene) events_.clear();
  if (parcel.kind == wire::Kind::event) {
    events_.push_back(parcel);
    if (events_.size() > kKeptEvents) events_.pop_front();
  } else {
    newest_[parcel.kind] = parcel;
  }
}

void Hall::show(const Message& message) {
  if (const auto* frame = std::get_if<std::shared_ptr<const LiveFrame>>(&message)) {
    boost::asio::post(io_, [this, frame = *frame] { to_each([&](Viewer& viewer) { viewer.send(frame); }); });
    return;
  }
  if (const auto* refusal = std::get_if<Refusal>(&message)) {
    boost::asio::post(io_, [this, id = refusal->viewer, notice = parcel_of(refusal->why)] {
      if (id == 0) return to_each([&](Viewer& viewer) { viewer.send(notice); });
      if (const auto found = viewers_.find(id); found != viewers_.end()) found->second->send(notice);
    });
    return;
  }
  const auto* event = std::get_if<LiveEvent>(&message);
  const auto* plan = std::get_if<ShownPlan>(&message);
  const bool is_start = event && event->kind == "started";
  const bool ends_plan = plan && plan->plan.needles.empty();
  boost::asio::post(io_, [this, is_start, ends_plan, parcel = as_parcel(message)] {
    if (is_start) events_.clear();
    if (ends_plan) {
      for (const auto kind : {wire::Kind::plan, wire::Kind::implant, wire::Kind::seeds, wire::Kind::dose})
        newest_.erase(kind);
    }
    keep(parcel);
    to_each([&](Viewer& viewer) { viewer.send(parcel); });
  });
}

void Hall::tell(const SessionStatus& status) {
  boost::asio::post(io_, [this, status] {
    status_ = status;
    say_status();
  });
}

void Hall::arrived(const std::shared_ptr<Viewer>& viewer) {
  viewers_[viewer->id()] = viewer;
  for (const auto& [kind, parcel] : newest_) viewer->send(parcel);
  for (const Parcel& event : events_) viewer->send(event);
  say_status();
  session_.welcome();
}

void Hall::left(std::uint64_t id) {
  if (viewers_.erase(id) == 0) return;
  if (holding_.leave(id)) session_.let_go();
  say_status();
}

void Hall::heard(Viewer& viewer, const wire::Seen& /*seen*/) { watch_.hear(viewer.id()); }

void Hall::heard(Viewer& viewer, const HandTarget& hand) {
  watch_.hear(viewer.id());
  watch_.watch(holding_.holder());
  if (holding_.holder() == viewer.id() && !watch_.is_stopped()) session_.aim(hand);
}

void Hall::heard(Viewer& viewer, const Command& command) {
  watch_.hear(viewer.id());
  if (command.what == Command::Do::take) {
    holding_.take(viewer.id());
    return say_status();
  }
  if (command.what == Command::Do::release) {
    if (holding_.holder() == viewer.id()) session_.let_go();
    holding_.release(viewer.id());
    return say_status();
  }
  if (row_of(command.what).needs_needle && holding_.holder() != viewer.id())
    return viewer.send(parcel_of(Notice{"another viewer holds the needle", "Ask for the needle"}));
  if (command.what == Command::Do::go_on) {
    watch_.go_on();
    return say_status();
  }
  if (!session_.ask({command, viewer.id()}))
    viewer.send(parcel_of(Notice{"too many requests are waiting", "Try again"}));
}

void Hall::say_status() {
  session_.hold(holding_.holder() != 0);
  OwnStatus own{.held = holding_.holder() != 0, .asking = holding_.asking(), .viewers = viewers_.size()};
  watch_.watch(holding_.holder());
  to_each([&](Viewer& viewer) {
    own.you_hold = holding_.holder() == viewer.id();
    own.hand_stopped = own.you_hold && watch_.is_stopped();
    own.lag_s = viewer.lag_s();
    own.you_ask = holding_.asks(viewer.id());
    own.dropped_messages = viewer.dropped_messages();
    own.skipped_frames = viewer.skipped_frames();
    viewer.send(parcel_of(status_, own));
  });
}

}  // namespace stylet::serve
