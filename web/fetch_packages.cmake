# SPDX-License-Identifier: GPL-3.0-or-later
# Brings the exact packages of web/package-lock.json into the build folder.
# Called with -DNPM= -DSOURCE= -DBUILD=
file(MAKE_DIRECTORY ${BUILD})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/.npmrc DESTINATION ${BUILD})
execute_process(
  COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
  WORKING_DIRECTORY ${BUILD}
  RESULT_VARIABLE status
  OUTPUT_VARIABLE output
  ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message("${output}")
  message(FATAL_ERROR
    "npm could not fetch the packages of the pages (web/package-lock.json); its words are above.\n"
    "They come from the npm registry, once: connect this machine to the network, or name your mirror with\n"
    "  npm config set registry ADDRESS\n"
    "and build again. Without them only the library can be built: cmake -DSTYLET_APPS=OFF")
endif()
file(TOUCH ${BUILD}/packages.stamp)
