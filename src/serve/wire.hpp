// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hand.hpp"
#include "stylet/core/result.hpp"
#include "stylet/serve/picture.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The messages of docs/live_protocol.md, to bytes and back.
namespace stylet::serve::wire {

inline constexpr int kProtocol = 2;  ///< its version
inline constexpr const char* kSubprotocol = "stylet-live-2";
inline constexpr std::size_t kLongestMessage = 1024;  ///< of a page [bytes]

enum class Kind : std::uint32_t {
  scene = 1,
  frame = 2,
  status = 3,
  event = 4,
  notice = 5,
  map = 6,
  hand = 16,
  command = 17
};

using Bytes = std::vector<std::byte>;

/// @param number counts the messages of a connection
Bytes encode(const Scene& scene, std::uint32_t number);
/// @param samples those that this connection has not got yet, instead of the frame's own
/// @param whole_curve they are all there are
Bytes encode(const LiveFrame& frame, std::span<const Step> curve, bool whole_curve, std::uint32_t number);
/// status, event, notice or map
Bytes encode(Kind kind, std::string_view json, std::uint32_t number);

/// What a page asks for, by the names of the protocol.
struct Command {
  enum class Do {
    take,
    release,
    hole,
    insertion,
    reset,
    pause,
    resume,
    step,
    open_case,
    replay,
    live,
    seek,
    play,
    predict,
    drawn
  };
  Do what{};
  std::string text;     ///< of hole and replay
  double number = 0.0;  ///< of insertion, step, case, seek, play and predict
};

/// Empty for what is malformed: wrong length, unknown kind or command, numbers that are not finite or out of range.
std::optional<std::variant<HandTarget, Command>> decode(std::span<const std::byte> message);

/// At most `most` samples: of each of equal runs the ones with the least and the largest axial force, in their order.
void thin(std::vector<Step>& curve, std::size_t most);

}  // namespace stylet::serve::wire
