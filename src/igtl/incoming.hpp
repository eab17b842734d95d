// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ras.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stylet::igtl {

/// Why a message is not used, for people.
struct Refusal {
  const char* kind = "";  ///< refusals of one kind are told of together; a word that stays the same
  std::string why;        ///< goes on after the name of the message: "its checksum is 0"
  std::string cure;       ///< a sentence without its full stop
};

/// A pose with the name of the tool that has it: of the message, or in TDATA and QTDATA of one of its tools.
struct ToolPose {
  std::string name;
  std::optional<RasMatrix> matrix;  ///< empty: there is no orientation
};

/// Name of the STRING with which a program gives the token.
inline constexpr const char* kTokenName = "Token";

/// The parts of a received message that a link uses.
struct Incoming {
  /// `text` is a STRING or a COMMAND, `other` a type that is not used, `refused` a message that cannot be used.
  enum class Kind { pose, status, text, other, refused } kind = Kind::other;
  std::string type;  ///< as sent, such as "TRANSFORM" or "POSITION"
  std::string name;
  std::vector<ToolPose> poses;              ///< of TRANSFORM, POSITION, TDATA, QTDATA
  std::uint16_t code = 0;                   ///< of a STATUS; 1 means OK
  std::string text;                         ///< of a STRING or a COMMAND, as sent
  std::optional<std::uint32_t> command_id;  ///< of a COMMAND
  std::string command_name;                 ///< of a COMMAND
  Refusal refusal;                          ///< of a message that cannot be used
};

}  // namespace stylet::igtl
