// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/serve/companion.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace stylet::cli {

/// How `stylet serve` is to speak OpenIGTLink.
struct IgtlArguments {
  std::string listen;         ///< [IP:]PORT
  std::string connect;        ///< HOST[:PORT]
  std::string hand = "page";  ///< or "igtl"
};
void add_igtl_options(CLI::App& app, IgtlArguments& arguments);

/// An open link, for a live session.
struct IgtlCompanion {
  std::shared_ptr<serve::Companion> companion;  ///< null: none was asked for
  std::string said;                             ///< where it is
  std::string warning;                          ///< of others in the network; may be empty
  Json json;                                    ///< the same for programs
};

/// Settings of a runner whose hand comes over OpenIGTLink: samples of 30 to 60 Hz are not late.
inline constexpr double kIgtlLateAfter_s = 0.1;

/// Errors: a place that is none, a port that is taken, a host that is not known, a program built without OpenIGTLink.
Result<IgtlCompanion> open_igtl(const IgtlArguments& arguments);

}  // namespace stylet::cli
