// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

namespace stylet::results {

/// The mark of a seed of a third in a picture, as SVG: a circle, a square or a triangle.
/// @param x, y its centre @param title what is shown when one points at it @param open not filled
std::string third_mark(double x, double y, std::size_t third, const std::string& title, bool open = false);

}  // namespace stylet::results
