// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet::detail {

/// The build id of the program or shared library that holds this code, in hexadecimal: a digest that the linker makes
/// of all that it links together. Another line of code, compiler or option is another one; `strip` leaves it, and two
/// builds alike have the same. Empty where it was linked without one (--build-id).
std::string build_id();

}  // namespace stylet::detail
