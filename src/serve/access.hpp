// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace stylet::serve {

/// Who may come in: who knows the token, but no page of another origin, and on the loopback interface under no name
/// that somebody else has pointed here. There, other users of this machine are kept out by the token alone.
class Access {
 public:
  enum class Names { loopback, any };
  /// @param token empty: none is asked for
  /// @param names under which the server answers; a name that is not this machine's own needs a token
  explicit Access(std::string token, Names names = Names::loopback) : token_(std::move(token)), names_(names) {}

  enum class Verdict { granted, foreign, no_token };
  /// @param target of the request, with its query
  /// @param host, origin of the request's headers; empty where it has none
  [[nodiscard]] Verdict check(std::string_view target, std::string_view host, std::string_view origin) const;
  /// The same for what anybody may see who reaches the server: the page itself.
  [[nodiscard]] Verdict check_open(std::string_view host) const;

  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  std::string token_;
  Names names_;
};

/// The path of a request's target, without its query.
std::string_view path_of(std::string_view target);
/// The value of `key` in a target's query, percent signs as they are; empty where there is none.
std::string_view query_value(std::string_view target, std::string_view key);
/// 32 hexadecimal digits nobody can guess.
std::string random_token();
/// Whether a token is the same in an address: letters, digits and -._~, at least one.
bool is_plain_token(std::string_view token);

}  // namespace stylet::serve
