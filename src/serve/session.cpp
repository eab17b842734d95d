// SPDX-License-Identifier: GPL-3.0-or-later
#include "session.hpp"

#include "spoken_command.hpp"
#include "stylet/core/survive.hpp"

#include <algorithm>

namespace stylet::serve {

namespace {

constexpr auto kStatusEvery = std::chrono::milliseconds(500);
constexpr auto kProgressEvery = std::chrono::milliseconds(50);
constexpr auto kImplantEvery = std::chrono::milliseconds(3);

}  // namespace

Session::Session(SessionSettings settings, Audience& audience)
    : settings_(std::move(settings)),
      audience_(audience),
      complaints_(settings_.say),
      case_(settings_),
      live_(settings_),
      replay_(settings_),
      pictures_(settings_) {
  if (settings_.companion) status_.companion.name = settings_.companion->name();
}

void Session::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Session::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

void Session::let_go() {
  HandTarget rest;
  rest.rest = true;
  live_.aim(rest);
}

void Session::fail(const Notice& why) {
  status_.state = SessionStatus::State::failed;
  status_.failure = why;
}

Progress Session::progress() {
  return [this](std::string_view stage, double fraction) {
    const auto now = SessionClock::now();
    if (now < last_progress_ + kProgressEvery && stage == status_.stage) return;
    last_progress_ = now;
    status_.stage = stage;
    status_.fraction = fraction;
    audience_.tell(status_);
  };
}

void Session::say_status() {
  live_.describe(status_);
  replay_.describe(status_);
  pictures_.describe(status_);
  if (status_.state == SessionStatus::State::ready) case_.describe(status_);
  audience_.tell(status_);
  next_status_ = SessionClock::now() + kStatusEvery;
}

/// Keeps a refusal that is for no viewer, since it is for the companion.
void Session::pass(const Message& message) {
  const auto* refusal = std::get_if<Refusal>(&message);
  if (refusal == nullptr || refusal->viewer != 0) return audience_.show(message);
  turn_.refuse(refusal->why);
}

/// @return whether it has a picture of the needle
bool Session::show(const Reply& reply) {
  bool has_picture = false;
  for (const Message& message : reply.show) {
    pass(message);
    const auto* frame = std::get_if<std::shared_ptr<const LiveFrame>>(&message);
    has_picture = has_picture || frame != nullptr;
    if (frame != nullptr ? (*frame)->is_news : std::holds_alternative<LiveSeeds>(message)) pass_moment();
  }
  if (reply.is_urgent) next_status_ = {};
  return has_picture;
}

void Session::follow(const Reply& reply, const Request& request) {
  show(reply);
  std::visit([&](const auto& where) { go(where, request); }, reply.next);
}

/// Opens a model in place of the open one. If that fails, whatever has the audience continues.
void Session::go(const ToOpen& what, const Request& request) {
  show(live_.hold());
  const SessionStatus before = status_;
  if (!what.is_compiled) {
    status_.state = SessionStatus::State::loading;
    status_.fraction = -1.0;
    status_.stage = "reading";
    say_status();
  }
  const auto opened = case_.open(what, progress());
  if (opened) return follow(*opened, request);
  const Notice why = notice_of(opened.error());
  if (live_.is_live() || is_replaying_) {
    refuse(request, why);
    status_ = before;
    live_.go_on();
  } else if (case_.is_open()) {
    refuse(request, why);
    follow(case_.last_needle(request), request);
  } else {
    fail(why);
  }
}

void Session::go(const ToLive& what, const Request& request) {
  const bool comes_back = !what.start && live_.has_needle();
  if (!what.start && !comes_back) return follow(case_.last_needle(request), request);
  show(replay_.leave());
  is_replaying_ = false;
  pictures_.open(case_.patient());
  is_awaited_ = true;
  if (comes_back) {
    audience_.show(case_.scene());
    show(live_.come_back());
  } else {
    const auto entered = live_.enter(*what.start);
    if (!entered) {
      refuse(request, notice_of(entered.error()));
      return fail(notice_of(entered.error()));
    }
    show(*entered);
  }
  status_.state = SessionStatus::State::ready;
}

/// Shows a recording. If it cannot be shown, whatever has the audience continues.
void Session::go(const ToReplay& what, const Request& request) {
  live_.freeze();
  const auto entered = replay_.enter(what.name, case_.list());
  if (!entered) {
    live_.go_on();
    const Notice why = notice_of(entered.error());
    return status_.state == SessionStatus::State::loading ? fail(why) : refuse(request, why);
  }
  show(live_.set_aside());
  is_replaying_ = true;
  show(*entered);
  pictures_.open(replay_.patient());
  status_.state = SessionStatus::State::ready;
  is_awaited_ = true;
}

void Session::carry_out(const Request& request) {
  const CommandRow& row = row_of(request.command.what);
  const bool counts = row.counts == While::any || (row.counts == While::live ? live_.is_live() : is_replaying_);
  if (counts) follow(ask_room(row, request), request);
  if (pictures_.wants_moment()) pass_moment();
  say_status();
}

/// Tells what the companion has not used, and carries out the commands that it has been given.
void Session::heed_companion() {
  if (!settings_.companion) return;
  Companion& companion = *settings_.companion;
  for (Notice& notice : companion.news()) {
    if (settings_.say) settings_.say(companion.name() + ": " + notice.text + ". " + notice.cure + ".");
    status_.companion.newest = std::move(notice);
    next_status_ = {};
  }
  status_.companion.not_used = companion.not_used();
  for (const GivenCommand& given : companion.take_commands()) given.answer(obey(given.text));
}

/// Carries out a command of the companion.
/// @return why it is not carried out; empty: it is
std::optional<Notice> Session::obey(const std::string& text) {
  const Result<Command> command = spoken_command(text);
  if (!command) return notice_of(command.error());
  const CommandRow& row = row_of(command->what);
  if (!turn_.may_command(status_.device))
    return Notice{"a page holds the needle", "Hand it over there, or start Stylet with --hand igtl"};
  const bool needs_live = row.counts == While::live && !live_.is_live();
  if (needs_live || (row.counts == While::replay && !is_replaying_))
    return Notice{needs_live ? "no needle is live now" : "no recording is shown now",
                  needs_live ? "End the replay first, or wait until the case is open" : "Show a recording first"};
  turn_.begin();
  carry_out({*command, 0});
  return turn_.end();
}

Reply Session::ask_room(const CommandRow& row, const Request& request) {
  switch (row.desk) {
    case Desk::open_case:
      return case_.ask(request);
    case Desk::live:
      return live_.ask(request);
    case Desk::replay:
      return replay_.ask(request);
    case Desk::pictures:
      return pictures_.ask(request);
    case Desk::hall:
      break;
  }
  return {};
}

/// Passes the newest moment on if pictures of it are made.
void Session::pass_moment() {
  ImageDesk& desk = pictures_.desk();
  if (!desk.is_busy()) return;
  if (is_replaying_) {
    auto [moment, probe] = replay_.moment();
    desk.take(std::move(moment), probe);
  } else if (auto state = live_.moment()) {
    desk.take(*std::move(state));
  }
}

void Session::tick(double dt_s) {
  if (case_.take_field()) {
    next_status_ = {};
    if (const auto& field = case_.model().field) live_.set_field(field);
    if (case_.model().field && !is_replaying_) pictures_.open(case_.patient());
  }
  if (const auto map = case_.map_news(is_replaying_)) audience_.show(*map);
  show(live_.follow_implant());
  pictures_.serve_companion(live_.is_live());
  heed_companion();
  const bool is_streaming = pictures_.serves_companion() && live_.is_running();
  if (pictures_.wants_moment() || is_streaming) pass_moment();
  show(pictures_.news(live_.is_live()));
  const bool is_whole = is_awaited_.exchange(false);
  if (!show(is_replaying_ ? replay_.tick(dt_s, is_whole) : live_.tick(is_whole)) && is_whole) is_awaited_ = true;
  live_.record_probe(pictures_.desk().probe());
  if (SessionClock::now() >= next_status_) say_status();
}

/// An exception ended a request. Whatever has the audience continues.
void Session::give_up(const Request& request, const Error& why) {
  complaints_.tell(why);
  const Notice notice = notice_of(why);
  if (live_.is_live() || is_replaying_) {
    refuse(request, notice);
    status_.state = SessionStatus::State::ready;
    live_.go_on();
  } else {
    fail(notice);
  }
  say_status();
}

/// Opens the first case, or shows the recording to start with.
void Session::begin() {
  const Request nobody{};
  if (settings_.replay.empty()) {
    go(ToOpen{0, settings_.cases.front().load}, nobody);
  } else {
    go(ToReplay{settings_.replay}, nobody);
  }
  say_status();
}

/// An exception ended work that nobody has asked for. It may come back in the next turn, and is told once in a while.
void Session::tell_all(const Error& why) {
  if (complaints_.tell(why)) audience_.show(Refusal{0, notice_of(why)});
}

/// Carries out the requests that wait, and shows the next picture when it is due.
/// @param before when the last one was due
void Session::turn(const std::stop_token& stop, SessionClock::time_point& before) {
  const auto fails = [this](const Error& why) { tell_all(why); };
  const auto period =
      std::chrono::duration_cast<SessionClock::duration>(std::chrono::duration<double>(1.0 / settings_.pictures_per_s));
  const auto next = live_.is_busy() ? std::min(before + period, SessionClock::now() + kImplantEvery) : before + period;
  const auto waiting = mail_.take(stop, next);
  const auto begun = SessionClock::now();
  for (const Request& request : waiting) {
    if (stop.stop_requested()) return;
    survive(
        "a request of a page", [&] { carry_out(request); }, [&](const Error& why) { give_up(request, why); });
  }
  const auto now = SessionClock::now();
  before += now - begun;  // a replay does not advance while requests are carried out
  if (now < before + period) {
    if (live_.is_busy())
      survive(
          "the seeds", [&] { show(live_.follow_implant()); }, fails);
    return;
  }
  const double dt_s = std::chrono::duration<double>(now - before).count();
  before = now;
  survive(
      "the picture of the needle", [&] { tick(dt_s); }, fails);
}

void Session::run(const std::stop_token& stop) {
  survive(
      "the start of the session", [&] { begin(); }, [&](const Error& why) { give_up({}, why); });
  auto before = SessionClock::now();
  while (!stop.stop_requested())
    survive(
        "the session", [&] { turn(stop, before); }, [this](const Error& why) { tell_all(why); });
  survive(
      "the end of the session", [&] { live_.end(); }, [this](const Error& why) { complaints_.tell(why); });
}

}  // namespace stylet::serve
