// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "igtl_companion.hpp"
#include "validators.hpp"

namespace stylet::cli {

void add_igtl_options(CLI::App& app, IgtlArguments& arguments) {
  CLI::Option* listen =
      option(&app, "--igtl", arguments.listen, "[IP:]PORT",
             "Send the simulation to programs that speak OpenIGTLink, such as 3D Slicer; PORT is the port to "
             "listen on (usually 18944), for this machine only unless an address is given");
  option(&app, "--igtl-connect", arguments.connect, "HOST[:PORT]",
         "Send the simulation to an OpenIGTLink server, such as PLUS: connect to it, and reconnect whenever the "
         "connection is lost")
      ->excludes(listen);
  app.add_flag("--igtl-no-checksum", arguments.no_checksum,
               "Take OpenIGTLink messages whose checksum (CRC) is wrong or 0, as 3D Slicer and PLUS can be set to; "
               "without it such messages are dropped");
  option(&app, "--hand", arguments.hand, "WHO",
         "Source of the needle's motion: page, or igtl for the transform HandleToReference received over "
         "OpenIGTLink")
      ->capture_default_str()
      ->check(one_of({"page", "igtl"}));
}

}  // namespace stylet::cli
