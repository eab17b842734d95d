// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl_companion.hpp"
#include "validators.hpp"

namespace stylet::cli {

void add_igtl_options(CLI::App& app, IgtlArguments& arguments) {
  CLI::Option* listen =
      app.add_option("--igtl", arguments.listen,
                     "Send the simulation to programs that speak OpenIGTLink, such as 3D Slicer; PORT is the port to "
                     "listen on (usually 18944), for this machine only unless an address is given")
          ->type_name("[IP:]PORT");
  app.add_option(
         "--igtl-connect", arguments.connect,
         "Send the simulation to an OpenIGTLink server, such as PLUS: connect to it, and reconnect whenever the "
         "connection is lost")
      ->type_name("HOST[:PORT]")
      ->excludes(listen);
  app.add_flag("--igtl-no-checksum", arguments.no_checksum,
               "Take OpenIGTLink messages whose checksum (CRC) is wrong or 0, as 3D Slicer and PLUS can be set to; "
               "without it such a message closes its connection");
  app.add_option("--hand", arguments.hand,
                 "Source of the needle's motion: page, or igtl for the transform HandleToReference received over "
                 "OpenIGTLink")
      ->capture_default_str()
      ->type_name("WHO")
      ->check(one_of({"page", "igtl"}));
}

}  // namespace stylet::cli
