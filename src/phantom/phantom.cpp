// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/phantom/phantom.hpp"

namespace stylet {
ContourSet demo_patient(const PhantomOptions&) { return {}; }
}  // namespace stylet
