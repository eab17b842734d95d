# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the library as a part of another project: no tests, no programs, and no setting of that project changes.
# Takes: STYLET (the library's sources), SOURCE (this folder), WORK (a folder to use), GENERATOR, CXX.
file(REMOVE_RECURSE ${WORK})
foreach(command "-S;${SOURCE}/subproject;-B;${WORK};-G;${GENERATOR};-DCMAKE_CXX_COMPILER=${CXX};-DCMAKE_BUILD_TYPE=Release;-DCMAKE_CXX_FLAGS_RELEASE=-O0;-DSTYLET=${STYLET}"
                "--build;${WORK}")  # without optimisation, which is quick to compile
  execute_process(COMMAND ${CMAKE_COMMAND} ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND ${WORK}/consumer COMMAND_ERROR_IS_FATAL ANY)
