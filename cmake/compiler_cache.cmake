# SPDX-License-Identifier: GPL-3.0-or-later
# Where ccache is installed it keeps compiled objects, and two clones in different folders share them: paths below the
# source folder are seen as relative ones, by ccache and in what the compiler writes.
add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
find_program(STYLET_CCACHE ccache DOC "Compiler cache; empty: none")
if(STYLET_CCACHE)
  foreach(language C CXX)
    if(NOT CMAKE_${language}_COMPILER_LAUNCHER)
      set(CMAKE_${language}_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=true
                                              CCACHE_SLOPPINESS=pch_defines,time_macros ${STYLET_CCACHE})
    endif()
  endforeach()
endif()
