# SPDX-License-Identifier: GPL-3.0-or-later
# Checks that a shared library exports only functions of the C interface. Variables: NM, LIBRARY.
execute_process(COMMAND ${NM} --dynamic --defined-only --format=posix ${LIBRARY} OUTPUT_VARIABLE symbols
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
set(functions 0)
foreach(symbol IN LISTS symbols)
  if(symbol MATCHES "^stylet_rt_[a-z_]+(@@STYLET_RT_[0-9]+)? T ")
    math(EXPR functions "${functions} + 1")
  elseif(NOT symbol MATCHES "^STYLET_RT_[0-9]+(@@STYLET_RT_[0-9]+)? A ")
    message(FATAL_ERROR "shown, but not of the interface: ${symbol}")
  endif()
endforeach()
if(functions LESS 10)
  message(FATAL_ERROR "only ${functions} functions of the interface are shown")
endif()
