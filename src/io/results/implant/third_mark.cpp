// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/third_mark.hpp"

#include "implant/implant_words.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

namespace stylet::results {

std::string third_mark(double x, double y, std::size_t third, const std::string& title, bool open) {
  std::string shape;
  if (third == 0) shape = fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\"", x, y);
  if (third == 1) shape = fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\"", x - 4, y - 4);
  if (third == 2) shape = fmt::format("<path d=\"M{:.1f} {:.1f}l5 9h-10z\"", x, y - 5.5);
  const std::string look =
      fmt::format("{}=\"{}\"", open ? "fill=\"none\" stroke-width=\"2\" stroke" : "fill", kThirdColours[third]);
  return shape + fmt::format(" {}><title>{}</title></{}>", look, html_escaped(title),
                             third == 0   ? "circle"
                             : third == 1 ? "rect"
                                          : "path");
}

}  // namespace stylet::results
