// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/whole_file.hpp"
#include "stylet/io/picture_io.hpp"

#include <fmt/format.h>
#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkmetaio/metaImage.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet {

namespace {

constexpr int kNarrowest = 512;   ///< pixels; a narrower picture is enlarged
constexpr int kRowsPerLine = 32;  ///< a line of text has this part of the picture's width
constexpr unsigned char kStripBlack = 0;
constexpr unsigned char kStripWhite = 235;

/// A grey image that is filled from its top left corner; VTK counts rows from the bottom.
class Sheet {
 public:
  Sheet(int width, int height) {
    image_->SetDimensions(width, height, 1);
    image_->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
    auto* values = static_cast<unsigned char*>(image_->GetScalarPointer());
    std::fill(values, values + static_cast<std::ptrdiff_t>(width) * height, kStripBlack);
  }
  unsigned char& at(int column, int row) {
    return *static_cast<unsigned char*>(image_->GetScalarPointer(column, height() - 1 - row, 0));
  }
  [[nodiscard]] int width() const { return image_->GetDimensions()[0]; }
  [[nodiscard]] int height() const { return image_->GetDimensions()[1]; }
  [[nodiscard]] vtkImageData* data() const { return image_; }

 private:
  vtkNew<vtkImageData> image_;
};

/// A line of text as an image of coverage, or nothing if it cannot be drawn.
struct DrawnText {
  explicit DrawnText(const std::string& text, int height) {
    vtkNew<vtkTextProperty> look;
    look->SetFontFamilyToArial();
    look->SetFontSize(std::max(6, (height * 3) / 4));
    look->SetColor(1.0, 1.0, 1.0);
    constexpr int kPointsPerInch = 72;
    std::array<int, 2> size{};
    if (text.empty() ||
        !vtkFreeTypeTools::GetInstance()->RenderString(look, vtkStdString(text), kPointsPerInch, image, size.data()))
      return;
    width = std::min(size[0], image->GetDimensions()[0]);
    rows = std::min(size[1], image->GetDimensions()[1]);
  }
  /// How much of a pixel the text covers, 0…255. @param row from the top
  [[nodiscard]] int coverage(int column, int row) const {
    constexpr int kAlpha = 3;
    const auto* pixel = static_cast<const unsigned char*>(image->GetScalarPointer(column, rows - 1 - row, 0));
    return image->GetNumberOfScalarComponents() > kAlpha ? pixel[kAlpha] : pixel[0];
  }
  vtkNew<vtkImageData> image;
  int width = 0, rows = 0;
};

void put_text(Sheet& sheet, const DrawnText& text, int left, int middle_row) {
  constexpr int kFull = 255;
  const int top = middle_row - text.rows / 2;
  for (int row = 0; row < text.rows; ++row) {
    for (int column = 0; column < text.width; ++column) {
      const int x = left + column;
      const int y = top + row;
      if (x < 0 || y < 0 || x >= sheet.width() || y >= sheet.height()) continue;
      unsigned char& to = sheet.at(x, y);
      to = std::max(to, static_cast<unsigned char>(text.coverage(column, row) * kStripWhite / kFull));
    }
  }
}

/// A round length for the bar: the longest of 1, 2 and 5 times a power of ten that is at most a quarter of the width.
double bar_mm(double width_mm) {
  const double most = 0.25 * width_mm;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most) return factor * power;
  }
  return power;
}

/// Puts the picture on the sheet, each pixel as a square of some pixels.
void put_picture(Sheet& sheet, const GreyPicture& picture, int enlarged) {
  for (int row = 0; row < picture.height * enlarged; ++row) {
    for (int column = 0; column < picture.width * enlarged; ++column)
      sheet.at(column, row) =
          picture.values[static_cast<std::size_t>(row / enlarged) * static_cast<std::size_t>(picture.width) +
                         static_cast<std::size_t>(column / enlarged)];
  }
}

/// Draws the bar, with feet at its ends. @return the column behind it
int put_bar(Sheet& sheet, int left, int middle_row, int length, int line) {
  for (int column = 0; column < length; ++column) {
    const bool end = column < 2 || column >= length - 2;
    const int half = end ? line / 4 : 1;
    for (int row = middle_row - half; row < middle_row + half; ++row) sheet.at(left + column, row) = kStripWhite;
  }
  return left + length;
}

}  // namespace

Result<> write_picture_png(const GreyPicture& picture, const std::string& caption, const std::string& scale_note,
                           const std::filesystem::path& path) {
  const int enlarged = std::max(1, (kNarrowest + picture.width - 1) / std::max(1, picture.width));
  const int width = picture.width * enlarged;
  const int line = width / kRowsPerLine;
  const int height = picture.height * enlarged;
  Sheet sheet(width, height + 2 * line + line / 2);
  put_picture(sheet, picture, enlarged);

  const double length_mm = bar_mm(picture.width * picture.pixel_width_mm);
  const int length = static_cast<int>(std::lround(length_mm / picture.pixel_width_mm * enlarged));
  const int first = height + line / 4 + line / 2;
  const int second = first + line;
  const int behind = put_bar(sheet, line / 2, first, std::min(length, width - line), line);
  put_text(sheet, DrawnText(fmt::format("{:g} mm{}{}", length_mm, scale_note.empty() ? "" : " ", scale_note), line),
           behind + line / 2, first);
  put_text(sheet, DrawnText(caption, line), line / 2, second);
  const DrawnText notice(kPictureNotice, line);
  put_text(sheet, notice, width - notice.width - line / 2, first);

  return detail::write_whole(path, [&](const std::filesystem::path& to) -> Result<> {
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName(to.c_str());
    writer->AddText("Comment", kPictureNotice);
    writer->SetCompressionLevel(9);
    writer->SetInputData(sheet.data());
    writer->Write();
    std::error_code code;
    if (writer->GetErrorCode() != 0 || std::filesystem::file_size(to, code) == 0 || code)
      return failure(path.string(), "the picture cannot be written",
                     "Check the space and the permissions of its folder");
    return Ok{};
  });
}

Result<> write_picture_mha(const GreyPicture& picture, const std::filesystem::path& path) {
  return detail::write_whole(path, [&](const std::filesystem::path& to) -> Result<> {
    const std::array<int, 3> size{picture.width, picture.height, 1};
    const std::array<double, 3> spacing{picture.pixel_width_mm, picture.pixel_height_mm, picture.pixel_width_mm};
    std::vector<std::uint8_t> values = picture.values;  // MetaIO takes no constant data
    vtkmetaio::MetaImage image(3, size.data(), spacing.data(), vtkmetaio::MET_UCHAR, 1, values.data());
    std::array<double, 9> axes{};
    Eigen::Map<Mat3> columns(axes.data());
    columns << picture.right, picture.down, picture.right.cross(picture.down);
    image.TransformMatrix(axes.data());
    image.Offset(picture.first_mm.data());
    image.AnatomicalOrientation("RAI");  // the file's way to say LPS: the first axis runs from right to left
    image.Comment(kPictureNotice);
    image.CompressedData(true);
    if (!image.Write(to.c_str()))
      return failure(path.string(), "the picture cannot be written",
                     "Check the space and the permissions of its folder");
    return Ok{};
  });
}

}  // namespace stylet
