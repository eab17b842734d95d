// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "messages.hpp"
#include "open_model.hpp"
#include "stylet/serve/session_settings.hpp"

#include <optional>
#include <variant>
#include <vector>

/// The rooms of a session (docs/architecture.md): OpenCase, LiveRoom, ReplayRoom and PictureRoom. A room answers a
/// request with a reply, and the session alone acts on it; no room calls another one.
namespace stylet::serve {

class ImplantDesk;

/// A needle that is going to be in front of the patient.
struct NeedleStart {
  OpenModel open;
  std::size_t insertion = 0;             ///< index in the model
  std::string name;                      ///< of the insertion, for pages and the recording
  std::string hole;                      ///< hole of the template; empty: none
  std::shared_ptr<ImplantDesk> implant;  ///< of the open case; null: it has no plan of seeds
  std::optional<std::size_t> needle;     ///< of this plan; empty: one beside it
};

/// The room stays as it is.
struct Stay {};

/// A model is to be opened in place of the open one. While it is loaded the needle is held.
struct ToOpen {
  std::size_t number = 0;  ///< of the case
  std::function<Result<LoadedCase>(const Progress&)> load;
  bool is_other_needle = false;                 ///< of the open case
  bool is_compiled = false;                     ///< loading takes no time
  bool goes_on = false;                         ///< the interrupted implant of the open case is to be taken up
  std::shared_ptr<const DisplayField> field{};  ///< null: it is to be prepared
};

/// A needle is to be live. Empty: the one that was set aside for a replay, or the one that was there last.
struct ToLive {
  std::optional<NeedleStart> start;
};

/// A recording is to be shown.
struct ToReplay {
  std::string name;
};

using Transition = std::variant<Stay, ToOpen, ToLive, ToReplay>;

/// The answer of a room.
struct Reply {
  Transition next{};
  std::vector<Message> show{};  ///< in this order, before the transition
  bool is_urgent = false;       ///< the status has changed and is to be told at once

  static Reply refusal(const Request& request, const Notice& why) { return {Stay{}, {Refusal{request.viewer, why}}}; }
  static Reply refusal(const Request& request, const Error& why) { return refusal(request, notice_of(why)); }
};

}  // namespace stylet::serve
