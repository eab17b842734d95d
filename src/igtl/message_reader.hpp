// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ras.hpp"
#include "stylet/core/result.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace stylet::igtl {

/// A message from outside, as far as a link is interested.
struct Incoming {
  enum class Kind { transform, status, other } kind = Kind::other;
  std::string name;
  RasMatrix matrix{};      ///< of a TRANSFORM
  std::uint16_t code = 0;  ///< of a STATUS; 1 is good
};

/// Takes a connection's bytes as they come and makes messages of them. Trusts nothing: a header's length is looked at
/// before a byte of the body is kept, and only bodies of at most kKept bytes are; other types pass by without being
/// stored. Reads header versions 1 and 2 (protocols 1 to 3); passes over metadata.
class MessageReader {
 public:
  static constexpr std::size_t kKept = 65536;
  /// @param longest [bytes] body of any type; images are large
  explicit MessageReader(std::uint64_t longest = std::uint64_t{1} << 28) : longest_(longest) {}

  /// @return an error at the first thing that is no message; the connection is then out of step and to be closed
  Result<> take(std::span<const std::uint8_t> bytes, const std::function<void(const Incoming&)>& sink);

 private:
  Result<> read_header();
  Result<> read_body(Incoming& message);

  std::uint64_t longest_;
  std::array<std::uint8_t, 58> header_{};
  std::size_t header_filled_ = 0;
  Incoming message_;
  std::uint16_t version_ = 0;
  std::uint64_t crc_ = 0;
  std::uint64_t body_left_ = 0;  ///< bytes still to come
  bool keep_ = false;
  std::vector<std::uint8_t> body_;
};

}  // namespace stylet::igtl
