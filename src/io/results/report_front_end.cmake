# SPDX-License-Identifier: GPL-3.0-or-later
# Builds web/report (npm, Vite) in the build folder and puts its pages with their styles and scripts into
# the library stylet_report_assets.
find_program(NPM npm)
find_program(NODE NAMES node nodejs)
if(NOT NPM OR NOT NODE)
  message(FATAL_ERROR "The report's front end needs Node.js 18 or later and npm, which were not found.\n"
                      "Install the packages nodejs and npm, or configure with -DSTYLET_APPS=OFF to build the library only.")
endif()

set(REPORT_SOURCE ${PROJECT_SOURCE_DIR}/web/report)
set(REPORT_BUILD ${CMAKE_BINARY_DIR}/web/report)
set(REPORT_TEMPLATE ${REPORT_SOURCE}/template.html)
set(REPORT_JS ${REPORT_BUILD}/dist/report.js)
set(REPORT_CSS ${REPORT_BUILD}/dist/report.css)
set(REPRODUCE_TEMPLATE ${REPORT_SOURCE}/reproduce.html)
set(REPRODUCE_JS ${REPORT_BUILD}/dist/reproduce.js)
set(REPRODUCE_CSS ${REPORT_BUILD}/dist/reproduce.css)
set(VALIDATE_TEMPLATE ${REPORT_SOURCE}/validate.html)
set(VALIDATE_JS ${REPORT_BUILD}/dist/validate.js)
set(VALIDATE_CSS ${REPORT_BUILD}/dist/validate.css)
file(GLOB_RECURSE report_sources CONFIGURE_DEPENDS ${REPORT_SOURCE}/src/*)

add_custom_command(
  OUTPUT ${REPORT_BUILD}/packages.stamp
  COMMAND ${CMAKE_COMMAND} -DNPM=${NPM} -DSOURCE=${REPORT_SOURCE} -DBUILD=${REPORT_BUILD}
          -P ${CMAKE_CURRENT_SOURCE_DIR}/fetch_front_end_packages.cmake
  DEPENDS ${REPORT_SOURCE}/package.json ${REPORT_SOURCE}/package-lock.json ${REPORT_SOURCE}/.npmrc
          ${CMAKE_CURRENT_SOURCE_DIR}/fetch_front_end_packages.cmake
  COMMENT "Fetching the packages of the report's front end"
  VERBATIM)
add_custom_command(
  OUTPUT ${REPORT_JS} ${REPORT_CSS} ${REPRODUCE_JS} ${REPRODUCE_CSS} ${VALIDATE_JS} ${VALIDATE_CSS}
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${REPORT_BUILD}/src
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${REPORT_SOURCE}/src ${REPORT_BUILD}/src
  COMMAND ${CMAKE_COMMAND} -E copy ${REPORT_SOURCE}/tsconfig.json ${REPORT_SOURCE}/vite.config.ts ${REPORT_BUILD}
  COMMAND ${NODE} node_modules/vite/bin/vite.js build --logLevel warn
  COMMAND ${NODE} node_modules/vite/bin/vite.js build --logLevel warn --mode reproduce
  COMMAND ${NODE} node_modules/vite/bin/vite.js build --logLevel warn --mode validate
  DEPENDS ${REPORT_BUILD}/packages.stamp ${report_sources} ${REPORT_SOURCE}/tsconfig.json ${REPORT_SOURCE}/vite.config.ts
  WORKING_DIRECTORY ${REPORT_BUILD}
  COMMENT "Building the report's front end"
  VERBATIM)

configure_file(report/assets.cpp.in ${REPORT_BUILD}/assets.cpp @ONLY)
set_source_files_properties(${REPORT_BUILD}/assets.cpp PROPERTIES
  OBJECT_DEPENDS "${REPORT_JS};${REPORT_CSS};${REPORT_TEMPLATE};${REPRODUCE_JS};${REPRODUCE_CSS};${REPRODUCE_TEMPLATE};${VALIDATE_JS};${VALIDATE_CSS};${VALIDATE_TEMPLATE}")
add_library(stylet_report_assets STATIC ${REPORT_BUILD}/assets.cpp ${REPORT_JS} ${REPORT_CSS} ${REPRODUCE_JS}
                                        ${REPRODUCE_CSS} ${VALIDATE_JS} ${VALIDATE_CSS})
target_include_directories(stylet_report_assets PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
