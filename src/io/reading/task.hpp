// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace stylet::detail {

/// The default cure in the error about a file that crashes its parser.
inline constexpr const char* kExportAgain =
    "The file is damaged or violates its format; export it again or in another format";

/// A task of the reading program (reading/program.hpp): to parse one kind of file, which becomes an `Answer`.
/// @tparam Arguments what the parser needs to know besides the path of the file
template <class Answer, class... Arguments>
struct Task {
  std::string_view name;            ///< by which the program knows it
  const char* cure = kExportAgain;  ///< last clause of the error if the parser fails
};

}  // namespace stylet::detail
