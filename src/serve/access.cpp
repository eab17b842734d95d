// SPDX-License-Identifier: GPL-3.0-or-later
#include "access.hpp"

#include "stylet/core/secret.hpp"

#include <fmt/format.h>

#include <random>

namespace stylet::serve {

namespace {

/// Without the port: "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string_view host_name(std::string_view host) {
  const auto bracket = host.rfind(']');
  const auto colon = host.rfind(':');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket)) return host;
  return host.substr(0, colon);
}

bool is_loopback_name(std::string_view host) {
  const std::string_view name = host_name(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace

Access::Verdict Access::check_open(std::string_view host) const {
  const bool any_name = names_ == Names::any && !token_.empty();
  return !any_name && !is_loopback_name(host) ? Verdict::foreign : Verdict::granted;
}

Access::Verdict Access::check(std::string_view target, std::string_view host, std::string_view origin) const {
  if (check_open(host) != Verdict::granted) return Verdict::foreign;
  if (!origin.empty()) {
    const auto scheme = origin.find("://");
    if (scheme == std::string_view::npos || origin.substr(scheme + 3) != host) return Verdict::foreign;
  }
  if (!token_.empty() && !is_same_secret(query_value(target, "token"), token_)) return Verdict::no_token;
  return Verdict::granted;
}

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view query_value(std::string_view target, std::string_view key) {
  const auto mark = target.find('?');
  if (mark == std::string_view::npos) return {};
  std::string_view query = target.substr(mark + 1);
  while (!query.empty()) {
    const auto end = query.find('&');
    const std::string_view pair = query.substr(0, end);
    if (pair.size() > key.size() && pair.substr(0, key.size()) == key && pair[key.size()] == '=')
      return pair.substr(key.size() + 1);
    if (end == std::string_view::npos) break;
    query.remove_prefix(end + 1);
  }
  return {};
}

bool is_plain_token(std::string_view token) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  return !token.empty() && token.find_first_not_of(plain) == std::string_view::npos;
}

std::string random_token() {
  std::random_device device;
  std::string token;
  for (int k = 0; k < 4; ++k) token += fmt::format("{:08x}", device());
  return token;
}

}  // namespace stylet::serve
