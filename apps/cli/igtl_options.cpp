// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl_companion.hpp"
#include "validators.hpp"

namespace stylet::cli {

void add_igtl_options(CLI::App& app, IgtlArguments& arguments) {
  CLI::Option* listen =
      app.add_option("--igtl", arguments.listen,
                     "Show the simulation to programs that speak OpenIGTLink, such as 3D Slicer: port "
                     "(18944 is usual) to listen on, of this machine only unless an address is given")
          ->type_name("[IP:]PORT");
  app.add_option("--igtl-connect", arguments.connect,
                 "The same, but connect to such a program, such as PLUS, and again whenever it comes back")
      ->type_name("HOST[:PORT]")
      ->excludes(listen);
  app.add_option("--hand", arguments.hand,
                 "Who moves the needle: page, or igtl: the transform HandleToReference that comes over OpenIGTLink")
      ->capture_default_str()
      ->type_name("WHO")
      ->check(one_of({"page", "igtl"}));
}

}  // namespace stylet::cli
