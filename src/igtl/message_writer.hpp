// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/igtl/picture.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stylet::igtl {

using Bytes = std::vector<std::uint8_t>;

/// An OpenIGTLink name's length; what is longer is cut, as every program that speaks the protocol does.
inline constexpr std::size_t kNameBytes = 20;
[[nodiscard]] inline std::string cut_name(const std::string& name) { return name.substr(0, kNameBytes); }

/// Codes of STATUS.
enum class StatusCode : std::uint16_t { ok = 1, not_ready = 13 };

// Each appends a complete message (header version 1, which everybody reads), stamped with the system's clock. What is
// in mm and LPS here is RAS on the wire.
void add_transform(Bytes& out, const std::string& name, const Pose& lps);
/// NDARRAY of six doubles: force [N], torque [N mm], RAS.
void add_wrench(Bytes& out, const std::string& name, const Wrench& lps);
void add_string(Bytes& out, const std::string& name, const std::string& text);
void add_points(Bytes& out, const std::string& name, std::span<const Triple> lps);
/// @param surface with triangles that name its points
void add_surface(Bytes& out, const std::string& name, const Surface& surface);
void add_status(Bytes& out, const std::string& name, StatusCode code, const std::string& text);

}  // namespace stylet::igtl
