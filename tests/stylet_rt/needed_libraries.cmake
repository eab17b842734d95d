# SPDX-License-Identifier: GPL-3.0-or-later
# Checks that a host program loads only the libraries that the engine and saved models need, and no library for the
# formats, meshers and pictures of the stylet program, not even through another library. Variable: LIBRARY.
execute_process(COMMAND ldd ${LIBRARY} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(NOT libraries MATCHES "libcholmod")
  message(FATAL_ERROR "this is no list of libraries:\n${libraries}")
endif()
string(TOLOWER "${libraries}" lower)
foreach(name vtk egl libgl x11 teem gmsh dcm libofstd hdf5 curl igtl)
  if(lower MATCHES "[^\n]*${name}[^\n]*")
    message(SEND_ERROR "needs ${CMAKE_MATCH_0}")
  endif()
endforeach()
