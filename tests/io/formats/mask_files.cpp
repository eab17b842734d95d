// SPDX-License-Identifier: GPL-3.0-or-later
#include "mask_files.hpp"

#include "files.hpp"

#include <zlib.h>
#include <Eigen/Geometry>

#include <cstring>
#include <sstream>
#include <stdexcept>

namespace stylet::test {

Mask::Mask() : labels(static_cast<std::size_t>(size[0] * size[1] * size[2]), 0) {
  const auto at = [&](int i, int j, int k) -> std::uint8_t& { return labels[i + size[0] * (j + size[1] * k)]; };
  for (int k = 2; k < 5; ++k) {
    for (int j = 3; j < 7; ++j) {
      for (int i = 2; i < 8; ++i) at(i, j, k) = 1;
    }
  }
  at(9, 7, 5) = 2;
}

Vec3 Mask::centre(int label) const {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int k = 0, n = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++n) {
        if (labels[n] != label) continue;
        sum += origin + axes * Vec3(i, j, k);
        ++count;
      }
    }
  }
  return sum / count;
}

Mat3 oblique_axes() {
  const Mat3 turn = (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(-0.2, Vec3::UnitZ())).toRotationMatrix();
  return turn * Vec3(2.0, 2.5, 4.0).asDiagonal();
}

Mat3 left_handed_axes() {
  Mat3 axes = oblique_axes();
  axes.col(2) *= -1.0;
  return axes;
}

namespace {

std::string deflated(const std::string& bytes, int window_bits) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib");
  std::string out(bytes.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string data_of(const Mask& mask) { return {mask.labels.begin(), mask.labels.end()}; }

std::string numbers(const Vec3& v) {
  std::ostringstream text;
  text.precision(17);
  text << v.x() << ' ' << v.y() << ' ' << v.z();
  return text.str();
}

std::string vector_text(const Vec3& v) {
  std::string text = "(" + numbers(v) + ")";
  for (char& c : text) {
    if (c == ' ') c = ',';
  }
  return text;
}

}  // namespace

std::string gzipped(const std::string& bytes) { return deflated(bytes, 15 + 16); }

std::string nifti(const Mask& mask, NiftiForm form) {
  const Mat3 lps_to_ras = Vec3(-1, -1, 1).asDiagonal();
  const Mat3 axes = lps_to_ras * mask.axes;
  const Vec3 origin = lps_to_ras * mask.origin;
  std::string bytes(352, '\0');
  poke<std::int32_t>(bytes, 0, 348);
  const std::array<std::int16_t, 8> dim{3,
                                        static_cast<std::int16_t>(mask.size[0]),
                                        static_cast<std::int16_t>(mask.size[1]),
                                        static_cast<std::int16_t>(mask.size[2]),
                                        1,
                                        1,
                                        1,
                                        1};
  for (std::size_t d = 0; d < 8; ++d) poke(bytes, 40 + 2 * d, dim[d]);
  poke<std::int16_t>(bytes, 70, 2);  // unsigned char
  poke<std::int16_t>(bytes, 72, 8);
  const double handed = axes.determinant() < 0.0 ? -1.0 : 1.0;
  poke(bytes, 76, static_cast<float>(handed));  // qfac
  for (int a = 0; a < 3; ++a) poke(bytes, 80 + 4 * a, static_cast<float>(axes.col(a).norm()));
  poke(bytes, 108, 352.0F);
  poke<char>(bytes, 123, 2);  // mm
  if (form == NiftiForm::sform) {
    poke<std::int16_t>(bytes, 254, 1);
    for (int row = 0; row < 3; ++row) {
      for (int a = 0; a < 3; ++a) poke(bytes, 280 + 16 * row + 4 * a, static_cast<float>(axes(row, a)));
      poke(bytes, 292 + 16 * row, static_cast<float>(origin[row]));
    }
  } else if (form == NiftiForm::qform) {
    Mat3 turn = axes.colwise().normalized();
    turn.col(2) *= handed;
    Eigen::Quaterniond q(turn);
    if (q.w() < 0.0) q.coeffs() *= -1.0;
    poke<std::int16_t>(bytes, 252, 1);
    const std::array<double, 6> values{q.x(), q.y(), q.z(), origin.x(), origin.y(), origin.z()};
    for (std::size_t i = 0; i < 6; ++i) poke(bytes, 256 + 4 * i, static_cast<float>(values[i]));
  }
  bytes.replace(344, 4, std::string("n+1\0", 4));
  return bytes + data_of(mask);
}

std::string nrrd(const Mask& mask, const std::string& encoding, const std::string& extra, const std::string& space) {
  std::ostringstream text;
  text << "NRRD0005\ntype: unsigned char\ndimension: 3\nspace: " << space << "\nsizes: " << mask.size[0] << ' '
       << mask.size[1] << ' ' << mask.size[2] << "\nspace directions: " << vector_text(mask.axes.col(0)) << ' '
       << vector_text(mask.axes.col(1)) << ' ' << vector_text(mask.axes.col(2))
       << "\nkinds: domain domain domain\nencoding: " << encoding << "\nspace origin: " << vector_text(mask.origin)
       << '\n'
       << extra << '\n';
  if (encoding == "raw") return text.str() + data_of(mask);
  if (encoding == "gzip") return text.str() + gzipped(data_of(mask));
  for (const int label : mask.labels) text << label << ' ';  // encoding ascii
  return text.str();
}

std::string metaimage(const Mask& mask, bool compressed, const std::string& data_file) {
  const std::string data = compressed ? deflated(data_of(mask), 15) : data_of(mask);
  std::ostringstream text;
  const Mat3 turn = mask.axes.colwise().normalized();
  text << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = "
       << (compressed ? "True" : "False") << '\n';
  if (compressed) text << "CompressedDataSize = " << data.size() << '\n';
  text << "TransformMatrix = " << numbers(turn.col(0)) << ' ' << numbers(turn.col(1)) << ' ' << numbers(turn.col(2))
       << "\nOffset = " << numbers(mask.origin)
       << "\nCenterOfRotation = 0 0 0\nElementSpacing = " << numbers(mask.axes.colwise().norm().transpose())
       << "\nDimSize = " << mask.size[0] << ' ' << mask.size[1] << ' ' << mask.size[2]
       << "\nElementType = MET_UCHAR\nElementDataFile = " << data_file << '\n';
  return data_file == "LOCAL" ? text.str() + data : text.str();
}

Result<LabelImage> read_mask(const std::string& name, const std::string& bytes) {
  const Folder folder;
  return read_label_image(write_file(folder / name, bytes));
}

}  // namespace stylet::test
