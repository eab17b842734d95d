// SPDX-License-Identifier: GPL-3.0-or-later
#include "message_reader.hpp"

#include "message_writer.hpp"

#include <fmt/format.h>
#include <igtl_header.h>
#include <igtl_position.h>
#include <igtl_qtdata.h>
#include <igtl_tdata.h>
#include <igtl_transform.h>
#include <igtl_util.h>

#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

namespace stylet::igtl {

namespace {

static_assert(sizeof(igtl_header) == IGTL_HEADER_SIZE);

Error no_message(std::string what) {
  return input_error("OpenIGTLink message", std::move(what), "Let the other program send OpenIGTLink");
}

/// The text of a field, up to a zero byte or the end of the field.
std::string_view text(const char* field, std::size_t room) { return {field, strnlen(field, room)}; }
std::string_view text(const std::uint8_t* field, std::size_t room) {
  return text(reinterpret_cast<const char*>(field), room);
}

bool is_type(std::string_view type) {
  return !type.empty() && std::all_of(type.begin(), type.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}
bool is_name(std::string_view name) {
  return std::all_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x20; });
}

Incoming::Kind kind_of(std::string_view type) {
  using enum Incoming::Kind;
  for (const std::string_view with_pose : {"TRANSFORM", "POSITION", "TDATA", "QTDATA"})
    if (type == with_pose) return pose;
  if (type == "STATUS") return status;
  return type == "STRING" || type == "COMMAND" ? Incoming::Kind::text : other;
}

std::size_t big16(const std::uint8_t* at) { return boost::endian::load_big_u16(at); }
std::size_t big32(const std::uint8_t* at) { return boost::endian::load_big_u32(at); }
float big_float(const std::uint8_t* at) { return std::bit_cast<float>(boost::endian::load_big_u32(at)); }

RasMatrix matrix_at(const std::uint8_t* at) {
  RasMatrix matrix{};
  for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] = big_float(at + k * sizeof(float));
  return matrix;
}

/// The matrix of a position and, behind it, a quaternion of all four numbers or of the three imaginary ones, whose real
/// one, which is not negative, makes the norm 1. Empty if the quaternion is missing or has another norm.
std::optional<RasMatrix> matrix_of_position(std::span<const std::uint8_t> content) {
  if (content.size() < IGTL_POSITION_MESSAGE_WITH_QUATERNION3_SIZE) return {};
  std::array<float, 7> v{};
  for (std::size_t k = 0; k < content.size() / sizeof(float); ++k) v[k] = big_float(content.data() + k * sizeof(float));
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

/// The tools of TDATA (matrices) or QTDATA (positions with quaternions).
std::vector<ToolPose> tools_of(std::span<const std::uint8_t> content, bool has_matrices) {
  constexpr std::size_t before = IGTL_TDATA_LEN_NAME + 2;  // the name, the kind of tool, a reserved byte
  const std::size_t size = has_matrices ? IGTL_TDATA_ELEMENT_SIZE : IGTL_QTDATA_ELEMENT_SIZE;
  std::vector<ToolPose> tools;
  for (; !content.empty(); content = content.subspan(size)) {
    const auto pose = content.subspan(before, size - before);
    tools.push_back({std::string(text(content.data(), IGTL_TDATA_LEN_NAME)),
                     has_matrices ? matrix_at(pose.data()) : matrix_of_position(pose)});
  }
  return tools;
}

}  // namespace

void MessageReader::refuse(const char* kind, std::string why, std::string cure) {
  message_.kind = Incoming::Kind::refused;
  message_.refusal = {kind, std::move(why), std::move(cure)};
}

Result<> MessageReader::read_header() {
  igtl_header h;
  std::memcpy(&h, header_.data(), sizeof h);
  igtl_header_convert_byte_order(&h);
  const std::string_view type = text(h.name, sizeof h.name);
  const std::string_view name = text(h.device_name, sizeof h.device_name);
  const std::uint64_t size = h.body_size;
  if (h.version == 0 || !is_type(type) || !is_name(name))
    return no_message("bytes that are no header of OpenIGTLink, where a message has to begin");
  if (size > options_.longest) return no_message(fmt::format("a {} of {} bytes", type, size));
  message_ = {};
  message_.type = type;
  message_.name = name;
  message_.kind = kind_of(type);
  version_ = h.version;
  crc_ = h.crc;
  body_left_ = size;
  body_.clear();
  if (h.version > 2) {
    refuse("header version", fmt::format("its header has version {}, which is not read", version_),
           "Let the other program send header version 1 or 2, which all releases of the protocol use");
  } else if (message_.kind != Incoming::Kind::other && size > kKept) {
    refuse("length", fmt::format("its body of {} bytes is longer than {}", size, kKept),
           "Let the other program send less in one message");
  }
  keep_ = message_.kind != Incoming::Kind::other && message_.kind != Incoming::Kind::refused;
  return Ok{};
}

void MessageReader::read_body() {
  if (options_.checksums && crc64(body_.data(), body_.size(), 0) != crc_) {
    return refuse("checksum", crc_ == 0 ? "its checksum is 0" : "its body does not match its checksum",
                  "Let the other program compute checksums (CRC-64), or accept messages without them "
                  "(--igtl-no-checksum)");
  }
  std::span<const std::uint8_t> content(body_);
  if (version_ == 2) {
    // Extended header: its own length, the lengths of the two parts of the metadata at the end, a message number.
    constexpr std::size_t shortest = 12;
    const std::size_t before = body_.size() < shortest ? 0 : big16(body_.data());
    const std::size_t after = body_.size() < shortest ? 0 : big16(body_.data() + 2) + big32(body_.data() + 4);
    if (before < shortest || before + after > body_.size())
      return refuse("length", "its extended header does not fit its length",
                    "Let the other program send messages of the protocol's version 3, or header version 1");
    content = content.subspan(before, body_.size() - before - after);
  }
  read_content(content);
}

void MessageReader::read_content(std::span<const std::uint8_t> content) {
  const std::string& type = message_.type;
  const std::size_t size = content.size();
  const auto is_wrong = [&](bool wrong) {
    if (wrong)
      refuse("length", fmt::format("its {} bytes are not the length of a {}", size, type),
             "Let the other program send messages as the protocol defines them");
    return wrong;
  };
  if (type == "TRANSFORM") {
    if (is_wrong(size != IGTL_TRANSFORM_SIZE)) return;
    message_.poses = {{message_.name, matrix_at(content.data())}};
  } else if (type == "POSITION") {
    if (is_wrong(size != IGTL_POSITION_MESSAGE_DEFAULT_SIZE && size != IGTL_POSITION_MESSAGE_WITH_QUATERNION3_SIZE &&
                 size != IGTL_POSITION_MESSAGE_POSITON_ONLY_SIZE))
      return;
    message_.poses = {{message_.name, matrix_of_position(content)}};
  } else if (type == "TDATA" || type == "QTDATA") {
    const bool has_matrices = type == "TDATA";
    if (is_wrong(size % (has_matrices ? IGTL_TDATA_ELEMENT_SIZE : IGTL_QTDATA_ELEMENT_SIZE) != 0)) return;
    message_.poses = tools_of(content, has_matrices);
  } else if (type == "STATUS") {
    if (is_wrong(size < 30)) return;
    message_.code = static_cast<std::uint16_t>(big16(content.data()));
  } else if (type == "STRING") {
    constexpr std::size_t before = 4;  // the encoding, and the length of the text
    if (is_wrong(size < before || size != before + big16(content.data() + 2))) return;
    message_.text.assign(content.begin() + before, content.end());
  } else {
    constexpr std::size_t before = 4 + kCommandNameBytes + 6;  // a number, the name, the encoding, the length
    if (is_wrong(size < before || size != before + big32(content.data() + before - 4))) return;
    message_.command_id = static_cast<std::uint32_t>(big32(content.data()));
    message_.command_name = text(content.data() + 4, kCommandNameBytes);
    message_.text.assign(content.begin() + before, content.end());
  }
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
    if (keep_) read_body();
    sink(message_);
  }
  return Ok{};
}

}  // namespace stylet::igtl
