// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet::detail {

/// The build id of the program or shared library that holds this code, in hexadecimal: a digest by the linker of
/// everything that it links. It changes with the code, the compiler and its options; it is the same for identical
/// builds and after `strip`. Empty if the program was linked without a build id (--build-id).
std::string build_id();

}  // namespace stylet::detail
