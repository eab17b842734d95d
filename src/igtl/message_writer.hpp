// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/igtl/picture.hpp"
#include "stylet/imaging/grey_picture.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stylet::igtl {

using Bytes = std::vector<std::uint8_t>;

/// Longest OpenIGTLink name; longer names are cut, as in every program that uses the protocol.
inline constexpr std::size_t kNameBytes = 20;
[[nodiscard]] inline std::string cut_name(const std::string& name) { return name.substr(0, kNameBytes); }

/// Bytes of the name in a COMMAND and in the answer to it.
inline constexpr std::size_t kCommandNameBytes = 128;

/// Codes of a STATUS message.
enum class StatusCode : std::uint16_t { ok = 1, not_ready = 13 };

// Each function appends a complete message to `out`, with the time of the system's clock. The header has version 1,
// which all programs can read. Arguments are in LPS and mm; the message is in RAS.
void add_transform(Bytes& out, const std::string& name, const Pose& lps);
/// NDARRAY of six doubles: force [N], torque [N mm], RAS.
void add_wrench(Bytes& out, const std::string& name, const Wrench& lps);
void add_string(Bytes& out, const std::string& name, const std::string& text);
/// RTS_COMMAND: the answer to the COMMAND of this number and name.
void add_answer(Bytes& out, const std::string& name, std::uint32_t command_id, const std::string& command_name,
                const std::string& text);
void add_points(Bytes& out, const std::string& name, std::span<const Triple> lps);
/// @param surface its triangles' corners must be indices of its points
void add_surface(Bytes& out, const std::string& name, const Surface& surface);
/// IMAGE of 8-bit grey values, one slice; its matrix has the centre of the image as its origin.
/// @param image its size must fit its values
void add_image(Bytes& out, const std::string& name, const GreyPicture& image);
void add_status(Bytes& out, const std::string& name, StatusCode code, const std::string& text);

}  // namespace stylet::igtl
