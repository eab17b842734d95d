# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the library to a fresh folder, builds the project beside this file against it, runs it.
# Takes: BUILD (the library's build folder), SOURCE (this folder), WORK (a folder to use), GENERATOR, CXX.
file(REMOVE_RECURSE ${WORK})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "exit status ${status}: ${command}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/prefix/bin/stylet --version)
foreach(program rt_loop rt_loop_cmake)
  execute_process(COMMAND ${WORK}/build/${program} none.stylet RESULT_VARIABLE status ERROR_VARIABLE said)
  if(NOT status EQUAL 2 OR NOT said MATCHES "none.stylet: no such file")
    message(FATAL_ERROR "${program}: exit status ${status}: ${said}")
  endif()
endforeach()

# The programs of this project are not beside the library that was installed to a folder of the test.
set(ENV{STYLET_READER} ${WORK}/prefix/libexec/stylet/stylet-reader)

# The example's own words come from a patient's file; the demo patient is written to one first.
run(${WORK}/prefix/bin/stylet --quiet phantom -o ${WORK}/case)
execute_process(COMMAND ${WORK}/build/first_insertion ${WORK}/case/phantom.dcm WORKING_DIRECTORY ${WORK}
                RESULT_VARIABLE status OUTPUT_VARIABLE said)
if(NOT status EQUAL 0 OR NOT said MATCHES "largest force [4-9]")
  message(FATAL_ERROR "first_insertion: exit status ${status}: ${said}")
endif()
foreach(file report.html forces.csv summary.json run.h5)
  if(NOT EXISTS ${WORK}/out/first/${file})
    message(FATAL_ERROR "first_insertion wrote no ${file}")
  endif()
endforeach()
execute_process(COMMAND ${WORK}/build/first_insertion none.dcm WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status
                ERROR_VARIABLE said)
if(NOT status EQUAL 2 OR NOT said MATCHES "none.dcm: no such file")
  message(FATAL_ERROR "first_insertion: exit status ${status}: ${said}")
endif()

foreach(private evidence measure serve)
  if(EXISTS ${WORK}/prefix/include/stylet/${private})
    message(FATAL_ERROR "headers of ${private} are installed, but not its library")
  endif()
endforeach()
