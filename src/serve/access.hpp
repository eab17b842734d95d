// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace stylet::serve {

/// Decides which requests are answered. A request needs the token. A request from a page of another origin is refused.
/// On the loopback interface a Host header other than localhost is refused too, because another site's name may have
/// been pointed at this machine (DNS rebinding); other users of this machine are kept out by the token alone.
class Access {
 public:
  enum class Names { loopback, any };
  /// @param token empty: no token is needed
  /// @param names host names under which the server answers; any names other than the loopback names need a token
  explicit Access(std::string token, Names names = Names::loopback) : token_(std::move(token)), names_(names) {}

  enum class Verdict { granted, foreign, no_token };
  /// @param target target of the request, with its query
  /// @param host, origin headers of the request; empty where it has none
  [[nodiscard]] Verdict check(std::string_view target, std::string_view host, std::string_view origin) const;
  /// The check for the page itself, which needs no token.
  [[nodiscard]] Verdict check_open(std::string_view host) const;

  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  std::string token_;
  Names names_;
};

/// The path of a request's target, without its query.
std::string_view path_of(std::string_view target);
/// The value of `key` in a target's query, not percent-decoded; empty where there is none.
std::string_view query_value(std::string_view target, std::string_view key);
/// 32 random hexadecimal digits.
std::string random_token();
/// Whether a token stays the same in a URL: at least one character, all of them letters, digits and -._~
bool is_plain_token(std::string_view token);

}  // namespace stylet::serve
