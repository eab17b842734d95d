// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "wire.hpp"

#include "stylet/core/printable.hpp"
#include "stylet/core/result.hpp"

#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace stylet::serve {

/// A notice to the viewer whose request was not carried out, or to all viewers about work that failed.
struct Refusal {
  std::uint64_t viewer = 0;  ///< 0: all
  Notice why;
};

/// A message to viewers, except the status.
using Message =
    std::variant<std::shared_ptr<const Scene>, std::shared_ptr<const LiveFrame>, LiveMap, ShownPlan, LiveImplant,
                 LiveSeeds, std::shared_ptr<const LiveDose>, std::shared_ptr<const LiveImage>, LiveEvent, Refusal>;

/// Receives the output of a session. The session's thread makes all calls; each must return at once.
class Audience {
 public:
  virtual ~Audience() = default;
  virtual void show(const Message& message) = 0;
  virtual void tell(const SessionStatus& status) = 0;
};

/// An error in the words of a notice.
inline Notice notice_of(const Error& error) {
  return {printable_clause(error.where, kLongestPlace) + ": " + printable_clause(error.what),
          printable_clause(error.cure)};
}

/// A message as bytes. Several connections share them; each puts its own number in.
struct Parcel {
  wire::Kind kind{};
  std::shared_ptr<const wire::Bytes> bytes;
};

/// @param message neither a picture of the loop, whose curve differs from viewer to viewer, nor a refusal
Parcel as_parcel(const Message& message);
Parcel parcel_of(const Notice& notice);

/// The part of a status that differs from viewer to viewer.
struct OwnStatus {
  bool held = false;        ///< some viewer holds the needle
  std::size_t asking = 0;   ///< viewers that ask for it
  std::size_t viewers = 0;  ///< connected viewers
  bool you_hold = false, you_ask = false;
  bool hand_stopped = false;      ///< it holds the needle, and its hand was stopped because it was silent
  std::optional<double> lag_s{};  ///< Outbox::lag_s()
  std::int64_t dropped_messages = 0, skipped_frames = 0;
};
Parcel parcel_of(const SessionStatus& status, const OwnStatus& own);

}  // namespace stylet::serve
