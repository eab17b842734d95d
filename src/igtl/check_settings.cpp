// SPDX-License-Identifier: GPL-3.0-or-later
#include "check_settings.hpp"

#include "message_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace stylet::igtl {

namespace {

Result<> in_range(const char* key, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return Ok{};
  return input_error(fmt::format("OpenIGTLink, {}", key),
                     fmt::format("{} {} is not within {}…{}", value, unit, low, high), "Give a value within the range");
}

Result<> check_names(const LinkSettings& s) {
  std::set<std::string> seen;
  for (const auto& [key, name] : {std::pair{"input", &s.input},
                                  {"probe_input", &s.probe_input},
                                  {"base", &s.base},
                                  {"tip", &s.tip},
                                  {"force", &s.force},
                                  {"shaft", &s.shaft},
                                  {"surface", &s.surface},
                                  {"probe", &s.probe},
                                  {"image", &s.image},
                                  {"status", &s.status}}) {
    const std::string where = fmt::format("OpenIGTLink, name {}", key);
    if (name->empty() || std::any_of(name->begin(), name->end(), [](char c) { return c <= ' ' || c > '~'; }))
      return input_error(where, fmt::format("'{}' is not a valid name", *name),
                         "Use letters, digits and signs without spaces");
    if (!seen.insert(cut_name(*name)).second)
      return input_error(
          where, fmt::format("'{}' is used twice (an OpenIGTLink name has {} bytes)", cut_name(*name), kNameBytes),
          "Give every message a different name, the received one too");
  }
  return Ok{};
}

}  // namespace

Result<> check(const LinkSettings& s) {
  const int lowest = s.role == Role::server ? 0 : 1;
  if (s.port < lowest || s.port > 65535)
    return input_error("OpenIGTLink, port", fmt::format("{} is not within {}…65535", s.port, lowest),
                       "Give a port within the range; 18944 is usual");
  if (s.host.empty())
    return input_error("OpenIGTLink, host", "there is no host", "Give an address such as 127.0.0.1 for this machine");
  if (auto ok = in_range("poses_hz", s.poses_hz, 1.0, 1000.0, "Hz"); !ok) return ok;
  if (auto ok = in_range("surface_hz", s.surface_hz, 0.1, s.poses_hz, "Hz"); !ok) return ok;
  if (auto ok = in_range("images_hz", s.images_hz, 0.1, s.poses_hz, "Hz"); !ok) return ok;
  if (auto ok = in_range("fresh_s", s.fresh_s, 0.01, 10.0, "s"); !ok) return ok;
  if (auto ok = in_range("max_connections", s.max_connections, 1, 64, "connections"); !ok) return ok;
  if (auto ok = in_range("give_up_s", s.give_up_s, 0.1, 600.0, "s"); !ok) return ok;
  if (auto ok = in_range("retry_s", s.retry_s, 0.01, 60.0, "s"); !ok) return ok;
  if (auto ok = in_range("longest_retry_s", s.longest_retry_s, s.retry_s, 600.0, "s"); !ok) return ok;
  return check_names(s);
}

}  // namespace stylet::igtl
