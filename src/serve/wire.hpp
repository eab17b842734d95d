// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "commands.hpp"
#include "hand.hpp"
#include "stylet/core/result.hpp"
#include "stylet/serve/image_picture.hpp"
#include "stylet/serve/implant_picture.hpp"
#include "stylet/serve/picture.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Encodes and decodes the messages of docs/live_protocol.md.
namespace stylet::serve::wire {

inline constexpr int kProtocol = 4;  ///< version of the protocol
inline constexpr const char* kSubprotocol = "stylet-live-4";
inline constexpr std::size_t kLongestMessage = 1024;  ///< [bytes] longest message of a page

enum class Kind : std::uint32_t {
  scene = 1,
  frame = 2,
  status = 3,
  event = 4,
  notice = 5,
  map = 6,
  plan = 7,
  implant = 8,
  seeds = 9,
  dose = 10,
  image = 11,
  hand = 16,
  command = 17,
  seen = 18
};

/// The number of the newest message that a page has taken up.
struct Seen {
  std::uint32_t number = 0;
};

using Bytes = std::vector<std::byte>;

/// @param number sequence number of the message on its connection
Bytes encode(const Scene& scene, std::uint32_t number);
/// @param curve samples that this connection has not received; they replace the samples of the frame
/// @param whole_curve whether `curve` starts at the beginning of the insertion
/// @param coarse the displacement is sent with 8 bits in place of 16
Bytes encode(const LiveFrame& frame, std::span<const Step> curve, bool whole_curve, std::uint32_t number,
             bool coarse = false);
Bytes encode(const LiveDose& dose, std::uint32_t number);
Bytes encode(const LiveImage& image, std::uint32_t number);
/// Encodes a message that is JSON: of any other kind.
Bytes encode(Kind kind, std::string_view json, std::uint32_t number);

/// Decodes a message of a page. Empty if it is malformed: wrong length, unknown kind or command, numbers that are not
/// finite or out of range.
std::optional<std::variant<HandTarget, Command, Seen>> decode(std::span<const std::byte> message);

/// Decodes the JSON of a command. Empty if it is malformed: an unknown command, an argument that is missing, of another
/// type or out of range.
std::optional<Command> decode_command(std::string_view json);

/// Reduces a curve to at most `most` samples: divides it into equal parts and keeps of each the samples with the least
/// and the largest axial force, in their order.
void thin(std::vector<Step>& curve, std::size_t most);

}  // namespace stylet::serve::wire
