// SPDX-License-Identifier: GPL-3.0-or-later
#include "message_writer.hpp"

#include "ras.hpp"

#include <fmt/format.h>
#include <igtl_header.h>
#include <igtl_image.h>
#include <igtl_ndarray.h>
#include <igtl_point.h>
#include <igtl_polydata.h>
#include <igtl_string.h>
#include <igtl_transform.h>
#include <igtl_util.h>

#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <chrono>
#include <cstring>

// This file uses the C functions of the OpenIGTLink library, not its message classes: the classes of version 1.11 free
// the memory of an NDARRAY with the wrong delete and allocate a list for every triangle.

namespace stylet::igtl {

namespace {

void copy_text(char* to, std::size_t room, const std::string& text) {
  std::copy_n(text.data(), std::min(room, text.size()), to);
}

/// The time: seconds since 1970 in the upper 32 bits and a binary fraction in the lower 32 bits.
std::uint64_t now_stamp() {
  using namespace std::chrono;
  const auto ns = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
  const auto seconds = static_cast<std::uint64_t>(ns / 1'000'000'000);
  const auto rest = static_cast<std::uint64_t>(ns % 1'000'000'000);
  return (seconds << 32) | ((rest << 32) / 1'000'000'000);
}

/// Extends `out` by a message with an empty body. @return position of the body
std::size_t begin(Bytes& out, std::size_t body_bytes) {
  out.resize(out.size() + IGTL_HEADER_SIZE + body_bytes);
  return out.size() - body_bytes;
}

/// Writes the header of a message whose body is complete. The body starts at `body` and reaches to the end of `out`.
void finish(Bytes& out, std::size_t body, const char* type, const std::string& name) {
  igtl_header header{};
  header.version = 1;
  copy_text(header.name, sizeof header.name, type);
  copy_text(header.device_name, sizeof header.device_name, name);
  header.timestamp = now_stamp();
  header.body_size = out.size() - body;
  header.crc = crc64(out.data() + body, header.body_size, 0);
  igtl_header_convert_byte_order(&header);
  std::memcpy(out.data() + body - IGTL_HEADER_SIZE, &header, IGTL_HEADER_SIZE);
}

}  // namespace

void add_transform(Bytes& out, const std::string& name, const Pose& lps) {
  RasMatrix m = ras_matrix(lps);
  igtl_transform_convert_byte_order(m.data());
  const std::size_t body = begin(out, IGTL_TRANSFORM_SIZE);
  std::memcpy(out.data() + body, m.data(), IGTL_TRANSFORM_SIZE);
  finish(out, body, "TRANSFORM", name);
}

void add_wrench(Bytes& out, const std::string& name, const Wrench& lps) {
  const Vec3 force = ras(lps.force);
  const Vec3 torque = ras(lps.torque);
  std::array<double, 6> values{force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z()};
  igtl_uint16 size = values.size();
  igtl_ndarray_info info{};
  info.type = IGTL_NDARRAY_STYPE_TYPE_FLOAT64;
  info.dim = 1;
  info.size = &size;
  info.array = values.data();
  const std::size_t body = begin(out, igtl_ndarray_get_size(&info, IGTL_TYPE_PREFIX_NONE));
  igtl_ndarray_pack(&info, out.data() + body, IGTL_TYPE_PREFIX_NONE);
  finish(out, body, "NDARRAY", name);
}

void add_string(Bytes& out, const std::string& name, const std::string& text) {
  constexpr igtl_uint16 ascii = 3;
  const std::size_t length = std::min<std::size_t>(text.size(), 65535);
  igtl_string_header header{ascii, static_cast<igtl_uint16>(length)};
  igtl_string_convert_byte_order(&header);
  const std::size_t body = begin(out, sizeof header + length);
  std::memcpy(out.data() + body, &header, sizeof header);
  std::memcpy(out.data() + body + sizeof header, text.data(), length);
  finish(out, body, "STRING", name);
}

void add_answer(Bytes& out, const std::string& name, std::uint32_t command_id, const std::string& command_name,
                const std::string& text) {
  constexpr std::uint16_t ascii = 3;
  constexpr std::size_t fixed = 4 + kCommandNameBytes + 6;
  const std::size_t body = begin(out, fixed + text.size());
  boost::endian::store_big_u32(out.data() + body, command_id);
  std::copy_n(command_name.begin(), std::min(command_name.size(), kCommandNameBytes), out.data() + body + 4);
  boost::endian::store_big_u16(out.data() + body + fixed - 6, ascii);
  boost::endian::store_big_u32(out.data() + body + fixed - 4, static_cast<std::uint32_t>(text.size()));
  std::copy(text.begin(), text.end(), out.data() + body + fixed);
  finish(out, body, "RTS_COMMAND", name);
}

void add_points(Bytes& out, const std::string& name, std::span<const Triple> lps) {
  const std::size_t body = begin(out, lps.size() * sizeof(igtl_point_element));
  for (std::size_t k = 0; k < lps.size(); ++k) {
    igtl_point_element point{};
    copy_text(point.name, sizeof point.name - 1, fmt::format("{}-{}", name, k));
    copy_text(point.group_name, sizeof point.group_name - 1, "Fiducial");
    std::fill(std::begin(point.rgba), std::end(point.rgba), igtl_uint8{255});
    const Vec3 at = ras(vec3(lps[k]));
    for (int i = 0; i < 3; ++i) point.position[i] = static_cast<float>(at[i]);
    igtl_point_convert_byte_order(&point, 1);
    std::memcpy(out.data() + body + k * sizeof point, &point, sizeof point);
  }
  finish(out, body, "POINT", name);
}

void add_surface(Bytes& out, const std::string& name, const Surface& surface) {
  static const Surface::Triangles none;
  const Surface::Triangles& triangles = surface.triangles ? *surface.triangles : none;
  std::vector<float> points;
  points.reserve(3 * surface.points.size());
  for (const auto& p : surface.points) points.insert(points.end(), {-p[0], -p[1], p[2]});
  std::vector<igtl_uint32> cells;
  cells.reserve(4 * triangles.size());
  // LPS to RAS is a rotation (half a turn about z), so triangles stay counter-clockwise seen from outside.
  for (const auto& t : triangles) cells.insert(cells.end(), {3, t[0], t[1], t[2]});
  igtl_polydata_info info{};
  info.header.npoints = static_cast<igtl_uint32>(surface.points.size());
  info.header.npolygons = static_cast<igtl_uint32>(triangles.size());
  info.header.size_polygons = static_cast<igtl_uint32>(cells.size() * sizeof(igtl_uint32));
  info.points = points.data();
  info.polygons = cells.data();
  const std::size_t body = begin(out, igtl_polydata_get_size(&info, IGTL_TYPE_PREFIX_NONE));
  igtl_polydata_pack(&info, out.data() + body, IGTL_TYPE_PREFIX_NONE);
  finish(out, body, "POLYDATA", name);
}

void add_image(Bytes& out, const std::string& name, const GreyPicture& image) {
  igtl_image_header header{};
  header.version = IGTL_IMAGE_HEADER_VERSION;
  header.num_components = 1;
  header.scalar_type = IGTL_IMAGE_STYPE_TYPE_UINT8;
  header.endian = IGTL_IMAGE_ENDIAN_BIG;
  header.coord = IGTL_IMAGE_COORD_RAS;
  header.size[0] = header.subvol_size[0] = static_cast<igtl_uint16>(image.columns);
  header.size[1] = header.subvol_size[1] = static_cast<igtl_uint16>(image.rows);
  header.size[2] = header.subvol_size[2] = 1;
  const Vec3 middle = image.point_mm(0.5 * (image.columns - 1), 0.5 * (image.rows - 1));
  Eigen::Map<Eigen::Matrix<float, 3, 4>> columns(header.matrix);
  columns.col(0) = ras(image.mm_per_pixel * image.right).cast<float>();
  columns.col(1) = ras(image.mm_per_pixel * image.down).cast<float>();
  columns.col(2) = ras(image.mm_per_pixel * image.right.cross(image.down)).cast<float>();
  columns.col(3) = ras(middle).cast<float>();
  igtl_image_convert_byte_order(&header);
  const std::size_t body = begin(out, IGTL_IMAGE_HEADER_SIZE + image.pixels.size());
  std::memcpy(out.data() + body, &header, IGTL_IMAGE_HEADER_SIZE);
  std::copy(image.pixels.begin(), image.pixels.end(),
            out.begin() + static_cast<std::ptrdiff_t>(body + IGTL_IMAGE_HEADER_SIZE));
  finish(out, body, "IMAGE", name);
}

void add_status(Bytes& out, const std::string& name, StatusCode code, const std::string& text) {
  // Layout: code (16 bits), sub-code (64 bits), name of the error (20 bytes), text with a zero byte at its end.
  constexpr std::size_t fixed = 30;
  const std::size_t body = begin(out, fixed + text.size() + 1);
  const std::uint16_t wire = boost::endian::native_to_big(static_cast<std::uint16_t>(code));
  std::memcpy(out.data() + body, &wire, sizeof wire);
  std::memcpy(out.data() + body + fixed, text.data(), text.size());
  finish(out, body, "STATUS", name);
}

}  // namespace stylet::igtl
