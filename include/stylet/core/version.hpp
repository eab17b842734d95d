// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Version of the library as "major.minor.patch". Where it was built in a clone of the repository, "+" and the commit
/// follow, and ".modified" where files of the clone differed from that commit: "0.2.0+1a2b3c4d.modified".
const char* version();

}  // namespace stylet
