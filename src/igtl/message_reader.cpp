// SPDX-License-Identifier: GPL-3.0-or-later
#include "message_reader.hpp"

#include <fmt/format.h>
#include <igtl_header.h>
#include <igtl_position.h>
#include <igtl_transform.h>
#include <igtl_util.h>

#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

namespace stylet::igtl {

namespace {

static_assert(sizeof(igtl_header) == IGTL_HEADER_SIZE);

Error garbage(std::string what, std::string cure = "Let the other program send OpenIGTLink") {
  return input_error("OpenIGTLink message", std::move(what), std::move(cure));
}

/// The text of a field, up to a zero byte or the end of the field.
std::string_view text(const char* field, std::size_t room) { return {field, strnlen(field, room)}; }

bool is_type(std::string_view type) {
  return !type.empty() && std::all_of(type.begin(), type.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}
bool is_name(std::string_view name) {
  return std::all_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x20; });
}

/// The matrix of a position and a unit quaternion; empty if there is no orientation or the quaternion has another norm.
std::optional<RasMatrix> pose_of_position(std::span<const std::uint8_t> content) {
  std::array<float, 7> v{};
  if (content.size() != IGTL_POSITION_MESSAGE_DEFAULT_SIZE &&
      content.size() != IGTL_POSITION_MESSAGE_WITH_QUATERNION3_SIZE)
    return {};
  for (std::size_t k = 0; k < content.size() / sizeof(float); ++k)
    v[k] = std::bit_cast<float>(boost::endian::load_big_u32(content.data() + k * sizeof(float)));
  // Three numbers are the imaginary part; the real one, which is not negative, makes the norm 1.
  if (content.size() == IGTL_POSITION_MESSAGE_WITH_QUATERNION3_SIZE)
    v[6] = std::sqrt(std::max(0.0F, 1.0F - v[3] * v[3] - v[4] * v[4] - v[5] * v[5]));
  const Eigen::Quaternionf q(v[6], v[3], v[4], v[5]);
  constexpr float tolerance = 1e-3F;
  if (!(std::abs(q.norm() - 1.0F) <= tolerance)) return {};
  RasMatrix matrix{};
  const Eigen::Matrix3f turn = q.normalized().toRotationMatrix();
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < 3; ++row)
      matrix[3 * column + row] = turn(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    matrix[9 + column] = v[column];
  }
  return matrix;
}

std::size_t big16(const std::uint8_t* at) { return boost::endian::load_big_u16(at); }
std::size_t big32(const std::uint8_t* at) { return boost::endian::load_big_u32(at); }

}  // namespace

Result<> MessageReader::read_header() {
  igtl_header h;
  std::memcpy(&h, header_.data(), sizeof h);
  igtl_header_convert_byte_order(&h);
  const std::string_view type = text(h.name, sizeof h.name);
  const std::string_view name = text(h.device_name, sizeof h.device_name);
  if (h.version != 1 && h.version != 2)
    return garbage(
        fmt::format("a header of version {}, which is not read", static_cast<unsigned>(h.version)),
        "Let the other program send messages with header version 1 or 2, which all releases of the protocol use");
  if (!is_type(type) || !is_name(name)) return garbage("a header whose type or name is not text");
  if (h.body_size > options_.longest) return garbage(fmt::format("a {} of {} bytes", type, std::uint64_t{h.body_size}));
  message_ = {};
  message_.type = type;
  if (type == "TRANSFORM" || type == "POSITION") message_.kind = Incoming::Kind::pose;
  if (type == "STATUS") message_.kind = Incoming::Kind::status;
  if (type == "STRING" && name == kTokenName) message_.kind = Incoming::Kind::token;
  message_.name = name;
  keep_ = message_.kind != Incoming::Kind::other;
  if (keep_ && h.body_size > kKept) return garbage(fmt::format("a {} of {} bytes", type, std::uint64_t{h.body_size}));
  version_ = h.version;
  crc_ = h.crc;
  body_left_ = h.body_size;
  body_.clear();
  return Ok{};
}

Result<> MessageReader::read_body(Incoming& message) {
  if (options_.checksums && crc64(body_.data(), body_.size(), 0) != crc_) {
    return garbage(fmt::format("a {} '{}' whose body does not match its checksum{}", message.type, message.name,
                               crc_ == 0 ? ", which is 0" : ""),
                   "Let the other program compute checksums (CRC-64), or switch their check off here");
  }
  std::span<const std::uint8_t> content(body_);
  if (version_ == 2) {
    // Extended header: its own length, the lengths of the two parts of the metadata at the end, a message number.
    if (body_.size() < 12) return garbage("a body shorter than its extended header");
    const std::size_t before = big16(body_.data());
    const std::size_t after = big16(body_.data() + 2) + big32(body_.data() + 4);
    if (before < 12 || before + after > body_.size()) return garbage("an extended header with wrong lengths");
    content = content.subspan(before, body_.size() - before - after);
  }
  if (message.type == "POSITION") {
    const auto matrix = pose_of_position(content);
    message.kind = matrix ? Incoming::Kind::pose : Incoming::Kind::other;
    if (matrix) message.matrix = *matrix;
  } else if (message.kind == Incoming::Kind::pose) {
    if (content.size() != IGTL_TRANSFORM_SIZE)
      return garbage(fmt::format("a TRANSFORM of {} bytes instead of {}", content.size(), IGTL_TRANSFORM_SIZE));
    std::memcpy(message.matrix.data(), content.data(), IGTL_TRANSFORM_SIZE);
    igtl_transform_convert_byte_order(message.matrix.data());
  } else if (message.kind == Incoming::Kind::token) {
    constexpr std::size_t before = 4;  // the encoding, and the length of the text
    if (content.size() < before || content.size() != before + big16(content.data() + 2))
      return garbage(fmt::format("a STRING of {} bytes", content.size()));
    message.text.assign(content.begin() + before, content.end());
  } else {
    if (content.size() < 30) return garbage(fmt::format("a STATUS of {} bytes", content.size()));
    message.code = static_cast<std::uint16_t>(big16(content.data()));
  }
  return Ok{};
}

Result<> MessageReader::take(std::span<const std::uint8_t> bytes, const std::function<void(const Incoming&)>& sink) {
  while (!bytes.empty()) {
    if (header_filled_ < header_.size()) {
      const std::size_t n = std::min(bytes.size(), header_.size() - header_filled_);
      std::copy_n(bytes.begin(), n, header_.begin() + static_cast<std::ptrdiff_t>(header_filled_));
      header_filled_ += n;
      bytes = bytes.subspan(n);
      if (header_filled_ < header_.size()) break;
      if (auto ok = read_header(); !ok) return ok;
    }
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), body_left_));
    if (keep_) body_.insert(body_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    body_left_ -= n;
    bytes = bytes.subspan(n);
    if (body_left_ > 0) break;
    header_filled_ = 0;
    if (keep_)
      if (auto ok = read_body(message_); !ok) return ok;
    sink(message_);
  }
  return Ok{};
}

}  // namespace stylet::igtl
