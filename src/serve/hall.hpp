// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "holder_watch.hpp"
#include "session.hpp"
#include "viewer.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <deque>
#include <functional>
#include <map>

namespace stylet::serve {

/// The viewers of a session: who is connected, who holds the needle, and which messages a newcomer gets. Everything
/// happens in the thread of `io`, except the Audience's calls, which only post work to it.
class Hall final : public Audience, public ViewerDesk {
 public:
  /// @param hand_silence_s [s] the needle is stopped when the page that holds it has said nothing for this time
  Hall(boost::asio::io_context& io, SessionSettings settings, double hand_silence_s)
      : io_(io), watch_(hand_silence_s), turn_(io), session_(std::move(settings), *this) {}

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] std::size_t size() const { return viewers_.size(); }
  /// Starts to watch the holder of the needle. Call it before the thread of `io` runs, or in it.
  void start() { wait_turn(); }
  void close();

  void show(const Message& message) override;
  void tell(const SessionStatus& status) override;

  void arrived(const std::shared_ptr<Viewer>& viewer) override;
  void left(std::uint64_t id) override;
  void heard(Viewer& viewer, const HandTarget& hand) override;
  void heard(Viewer& viewer, const Command& command) override;
  void heard(Viewer& viewer, const wire::Seen& seen) override;

 private:
  void wait_turn();
  void stop_silent_hand();
  void keep(const Parcel& parcel);
  void to_each(const std::function<void(Viewer&)>& send) const;
  void say_status();

  boost::asio::io_context& io_;
  std::map<std::uint64_t, std::shared_ptr<Viewer>> viewers_;
  Holding holding_;
  HolderWatch watch_;
  boost::asio::steady_timer turn_;
  std::map<wire::Kind, Parcel> newest_;  ///< for newcomers, in this order
  std::deque<Parcel> events_;            ///< since the start of the insertion, for newcomers
  SessionStatus status_;
  Session session_;  ///< last member, so that it ends before the others
};

}  // namespace stylet::serve
