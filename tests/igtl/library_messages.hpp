// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <igtlMath.h>
#include <igtlQuaternionTrackingDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace stylet::test {

using Raw = std::vector<std::uint8_t>;

/// A message packed by the OpenIGTLink library.
inline Raw packed(::igtl::MessageBase& message) {
  message.Pack();
  const auto* first = static_cast<const std::uint8_t*>(message.GetPackPointer());
  return {first, first + message.GetPackSize()};
}

/// A TRANSFORM. @param m columns of the rotation, then the position
inline Raw library_transform(const char* name, const std::array<float, 12>& m) {
  auto message = ::igtl::TransformMessage::New();
  message->SetDeviceName(name);
  ::igtl::Matrix4x4 matrix{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 3; ++row) matrix[row][column] = m[3 * column + row];
  matrix[3][3] = 1.0F;
  message->SetMatrix(matrix);
  return packed(*message);
}

inline Raw library_status(const char* name, int code) {
  auto message = ::igtl::StatusMessage::New();
  message->SetDeviceName(name);
  message->SetCode(code);
  message->SetErrorName("error");
  message->SetStatusString("in words");
  return packed(*message);
}

/// Writes a big-endian number.
inline void put(Raw& to, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t k = 0; k < bytes; ++k) to.at(at + k) = static_cast<std::uint8_t>(value >> (8 * (bytes - 1 - k)));
}

/// Writes length and checksum of the body into the header.
inline void seal(Raw& message) {
  put(message, 42, message.size() - 58, 8);
  put(message, 50, crc64(message.data() + 58, message.size() - 58, 0), 8);
}

/// A COMMAND with header version 1, as the protocol's version 3 defines it; the library of Debian 12 has none.
inline Raw command(const std::string& device, std::uint32_t id, const std::string& name, const std::string& text) {
  Raw m(58 + 138 + text.size());
  put(m, 0, 1, 2);
  std::memcpy(m.data() + 2, "COMMAND", 7);
  device.copy(reinterpret_cast<char*>(m.data()) + 14, 20);
  put(m, 58, id, 4);
  name.copy(reinterpret_cast<char*>(m.data()) + 62, 128);
  put(m, 190, 3, 2);
  put(m, 192, text.size(), 4);
  text.copy(reinterpret_cast<char*>(m.data()) + 196, text.size());
  seal(m);
  return m;
}

/// A matrix with the unit rotation at (x, y, z).
inline std::array<float, 12> at(float x, float y, float z) { return {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}; }

/// TDATA or QTDATA "Tracker" of a tool "Stylus" and of a tool "HandleToReference" with this matrix.
inline Raw library_tools(const std::string& type, const std::array<float, 12>& handle) {
  const std::array tools{std::pair{"Stylus", at(1, 2, 3)}, std::pair{"HandleToReference", handle}};
  if (type == "TDATA") {
    auto message = ::igtl::TrackingDataMessage::New();
    message->SetDeviceName("Tracker");
    for (const auto& [name, m] : tools) {
      auto tool = ::igtl::TrackingDataElement::New();
      tool->SetName(name);
      tool->SetType(::igtl::TrackingDataElement::TYPE_6D);
      ::igtl::Matrix4x4 matrix{};
      for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 3; ++row) matrix[row][column] = m[3 * column + row];
      tool->SetMatrix(matrix);
      message->AddTrackingDataElement(tool);
    }
    return packed(*message);
  }
  auto message = ::igtl::QuaternionTrackingDataMessage::New();
  message->SetDeviceName("Tracker");
  for (const auto& [name, m] : tools) {
    auto tool = ::igtl::QuaternionTrackingDataElement::New();
    tool->SetName(name);
    tool->SetType(::igtl::QuaternionTrackingDataElement::TYPE_6D);
    ::igtl::Matrix4x4 matrix{};
    for (std::size_t column = 0; column < 3; ++column)
      for (std::size_t row = 0; row < 3; ++row) matrix[row][column] = m[3 * column + row];
    std::array<float, 4> quaternion{};
    ::igtl::MatrixToQuaternion(matrix, quaternion.data());
    tool->SetPosition(m[9], m[10], m[11]);
    tool->SetQuaternion(quaternion.data());
    message->AddQuaternionTrackingDataElement(tool);
  }
  return packed(*message);
}

}  // namespace stylet::test
