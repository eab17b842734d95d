// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace stylet::serve {

/// Who may come in. On the loopback interface anybody of this machine, but no page of another origin and no name that
/// somebody else has pointed here; elsewhere who knows the token.
class Access {
 public:
  /// @param token empty: none is asked for, the server listens on the loopback interface
  explicit Access(std::string token) : token_(std::move(token)) {}

  enum class Verdict { granted, foreign, no_token };
  /// @param target of the request, with its query
  /// @param host, origin of the request's headers; empty where it has none
  [[nodiscard]] Verdict check(std::string_view target, std::string_view host, std::string_view origin) const;
  /// The same for what anybody may see who reaches the server: the page itself.
  [[nodiscard]] Verdict check_open(std::string_view host) const;

  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  std::string token_;
};

/// The path of a request's target, without its query.
std::string_view path_of(std::string_view target);
/// The value of `key` in a target's query, percent signs as they are; empty where there is none.
std::string_view query_value(std::string_view target, std::string_view key);
/// 32 hexadecimal digits nobody can guess.
std::string random_token();

}  // namespace stylet::serve
