// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/files.hpp"
#include "stylet/io/picture_io.hpp"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr int kScaleWidth = 52;  // pixels beside the picture for the scale
constexpr int kTextHeight = 26;  // pixels above and below it for a line of text
constexpr int kMargin = 8;
constexpr int kLetters = 13;  // size of letters in points at 72 dots per inch
constexpr unsigned char kInk = 200;
constexpr int kNarrowest = 512;  // pixels; a narrower picture is enlarged

/// A grey canvas whose rows are counted from the top.
class Sheet {
 public:
  Sheet(int columns, int rows) : columns_(columns), rows_(rows) {
    image_->SetDimensions(columns, rows, 1);
    image_->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
    std::fill_n(static_cast<unsigned char*>(image_->GetScalarPointer()),
                static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), static_cast<unsigned char>(0));
  }
  void set(int column, int row, unsigned char value) {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
    *static_cast<unsigned char*>(image_->GetScalarPointer(column, rows_ - 1 - row, 0)) = value;
  }
  void fill(int column, int row, int width, int height, unsigned char value) {
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) set(column + i, row + j, value);
  }
  /// Writes a text whose left end is at the column and whose middle is at the row.
  void text(int column, int row, const std::string& words) {
    vtkNew<vtkTextProperty> letters;
    letters->SetFontFamilyToArial();
    letters->SetFontSize(kLetters);
    letters->SetColor(1.0, 1.0, 1.0);
    letters->SetJustificationToLeft();
    letters->SetVerticalJustificationToBottom();
    vtkNew<vtkImageData> drawn;
    int size[2] = {0, 0};
    vtkTextRenderer* const renderer = vtkTextRenderer::GetInstance();
    if (renderer == nullptr || !renderer->RenderString(letters, words, drawn, size, 72)) return;
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        const auto* const rgba = static_cast<const unsigned char*>(
            drawn->GetScalarPointer(drawn->GetExtent()[0] + i, drawn->GetExtent()[2] + j, 0));
        if (rgba[3] > 0) set(column + i, row + size[1] / 2 - j, static_cast<unsigned char>(rgba[3] * kInk / 255));
      }
    }
  }
  [[nodiscard]] vtkImageData* image() { return image_; }

 private:
  int columns_, rows_;
  vtkNew<vtkImageData> image_;
};

/// A round length for a bar [mm]: the longest of 1, 2 and 5 times a power of ten that is at most a quarter of the
/// width.
double bar_length(double width_mm) {
  const double most = 0.25 * width_mm;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most) return factor * power;
  }
  return power;
}

/// A bar with feet at its ends, and its length in words.
void draw_bar(Sheet& sheet, const GreyPicture& picture, const std::string& note, int left, int row) {
  const double length_mm = bar_length(picture.columns * picture.mm_per_pixel);
  const int length = static_cast<int>(std::lround(length_mm / picture.mm_per_pixel));
  sheet.fill(left, row, length, 2, kInk);
  for (const int end : {left, left + length - 2}) sheet.fill(end, row - 4, 2, 10, kInk);
  sheet.text(left + length + kMargin, row, fmt::format("{:g} mm{}{}", length_mm, note.empty() ? "" : " ", note));
}

/// The same picture with each pixel as a square of some pixels.
GreyPicture enlarged(const GreyPicture& picture, int by) {
  GreyPicture large = picture;
  large.columns *= by;
  large.rows *= by;
  large.mm_per_pixel /= by;
  large.pixels.resize(static_cast<std::size_t>(large.columns) * static_cast<std::size_t>(large.rows));
  for (int row = 0; row < large.rows; ++row) {
    for (int column = 0; column < large.columns; ++column)
      large.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(large.columns) +
                   static_cast<std::size_t>(column)] = picture.at(row / by, column / by);
  }
  return large;
}

void draw_scale(Sheet& sheet, const GreyPicture& picture, double surface_row, int left, int top) {
  const double step = 10.0 / picture.mm_per_pixel;
  sheet.fill(left, top, 1, std::min(picture.rows, static_cast<int>(surface_row) + 1), kInk / 2);
  for (int cm = 0; surface_row - cm * step >= 0.0; ++cm) {
    const int row = top + static_cast<int>(std::lround(surface_row - cm * step));
    const bool named = cm % 5 == 0;
    sheet.fill(left, row, named ? 12 : 7, 1, kInk);
    if (named && cm > 0) sheet.text(left + 16, row, fmt::format("{} cm", cm));
  }
}

}  // namespace

Result<> write_picture_png(const GreyPicture& original, const PictureMarks& marks, const std::filesystem::path& path) {
  const int by = std::max(1, (kNarrowest + original.columns - 1) / std::max(1, original.columns));
  const GreyPicture picture = enlarged(original, by);
  const int top = marks.title.empty() ? kMargin : kTextHeight;
  const int bottom = (marks.notice.empty() ? kMargin : kTextHeight) + (marks.bar_note ? kTextHeight : 0);
  const int right = marks.surface_row ? kScaleWidth : kMargin;
  Sheet sheet(kMargin + picture.columns + right, top + picture.rows + bottom);
  for (int row = 0; row < picture.rows; ++row)
    for (int column = 0; column < picture.columns; ++column)
      sheet.set(kMargin + column, top + row, picture.at(row, column));
  for (const auto& dot : marks.dots)
    sheet.fill(kMargin + static_cast<int>(std::lround(by * dot[0])), top + static_cast<int>(std::lround(by * dot[1])),
               2, 2, kInk);
  if (marks.surface_row) draw_scale(sheet, picture, by * *marks.surface_row, kMargin + picture.columns + 4, top);
  if (!marks.title.empty()) sheet.text(kMargin, top / 2, marks.title);
  const int under = top + picture.rows;
  if (marks.bar_note) draw_bar(sheet, picture, *marks.bar_note, kMargin, under + kTextHeight / 2);
  if (!marks.notice.empty()) sheet.text(kMargin, under + bottom - kTextHeight / 2, marks.notice);

  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  if (!marks.notice.empty()) writer->AddText("Comment", marks.notice.c_str());
  writer->SetInputData(sheet.image());
  writer->Write();
  vtkUnsignedCharArray* const bytes = writer->GetResult();
  if (bytes == nullptr || bytes->GetNumberOfValues() == 0)
    return failure(path.string(), "the PNG encoder failed", "Write a .mha file instead");
  return write_whole_file(path, {reinterpret_cast<const char*>(bytes->GetPointer(0)),
                                 static_cast<std::size_t>(bytes->GetNumberOfValues())});
}

}  // namespace stylet
