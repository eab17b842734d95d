# SPDX-License-Identifier: GPL-3.0-or-later
# Headers that nearly every file of a target includes are compiled once for it. Not in debug builds, which compile each
# file by itself so that a missing include shows, and not in those with sanitizers, whose commands clang-tidy reads.

# stylet_precompile(TARGET [HEADER…]): the headers of the standard library and of Eigen, and those named.
function(stylet_precompile target)
  if(NOT CMAKE_UNITY_BUILD OR STYLET_SANITIZE)
    return()
  endif()
  target_precompile_headers(${target} PRIVATE <Eigen/Dense> <algorithm> <array> <cmath> <functional> <map> <memory> <optional>
                            <span> <string> <vector> ${ARGN})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)  # so that a compiler cache can follow
  endif()
endfunction()
