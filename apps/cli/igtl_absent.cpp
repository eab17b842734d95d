// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl_companion.hpp"

namespace stylet::cli {

Result<IgtlCompanion> open_igtl(const IgtlArguments& arguments) {
  if (arguments.listen.empty() && arguments.connect.empty() && arguments.hand == "page") return IgtlCompanion{};
  return input_error("stylet serve, OpenIGTLink", "this stylet was built without OpenIGTLink",
                     "Build stylet with -D STYLET_IGTL=ON and the OpenIGTLink library");
}

}  // namespace stylet::cli
