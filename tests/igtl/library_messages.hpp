// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>

#include <array>
#include <cstdint>
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

/// A matrix with the unit rotation at (x, y, z).
inline std::array<float, 12> at(float x, float y, float z) { return {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}; }

}  // namespace stylet::test
