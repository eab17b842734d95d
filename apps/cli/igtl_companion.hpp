// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/serve/companion.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>

namespace stylet::cli {

/// Command-line arguments of `stylet serve` for OpenIGTLink.
struct IgtlArguments {
  std::string listen;         ///< [IP:]PORT
  std::string connect;        ///< HOST[:PORT]
  bool no_checksum = false;   ///< take messages whose checksum is wrong
  std::string hand = "page";  ///< mover of the needle: "page" or "igtl"
};
void add_igtl_options(CLI::App& app, IgtlArguments& arguments);

/// An open OpenIGTLink connection for a live session.
struct IgtlCompanion {
  std::shared_ptr<serve::Companion> companion;  ///< null: OpenIGTLink is not used
  std::string said;                             ///< its address and role, for the terminal
  std::string warning;                          ///< warning about access from the network; may be empty
  /// Lets programs of other users and machines in that give this token; empty if OpenIGTLink is not used.
  std::function<void(const std::string&)> accept_token;
  Json json;  ///< its address and role as JSON
};

/// RunnerSettings::late_after_s when the hand's poses come over OpenIGTLink: poses at 30 to 60 Hz do not count as late.
inline constexpr double kIgtlLateAfter_s = 0.1;

/// Opens the connection. Errors: an invalid address, a port in use, an unknown host, a program built without
/// OpenIGTLink.
Result<IgtlCompanion> open_igtl(const IgtlArguments& arguments);

}  // namespace stylet::cli
