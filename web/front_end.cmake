# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the pages of web/ (npm, Vite) in the build folder. Include this, then for each folder of pages
#   stylet_web_pages(FOLDER report PAGES report reproduce validate OUTPUTS variable)
# which builds PAGE.js and PAGE.css of each and puts their places into the variable.
find_program(NPM npm)
find_program(NODE NAMES node nodejs)
if(NOT NPM OR NOT NODE)
  message(FATAL_ERROR "The pages need Node.js 18 or later and npm, which were not found.\n"
                      "Install the packages nodejs and npm, or configure with -DSTYLET_APPS=OFF to build the library only.")
endif()
set(STYLET_WEB_SOURCE ${PROJECT_SOURCE_DIR}/web)
set(STYLET_WEB_BUILD ${PROJECT_BINARY_DIR}/web)
include_guard(GLOBAL)

file(GLOB_RECURSE STYLET_WEB_SOURCES CONFIGURE_DEPENDS ${STYLET_WEB_SOURCE}/report/*.ts ${STYLET_WEB_SOURCE}/report/*.css
     ${STYLET_WEB_SOURCE}/live/*.ts ${STYLET_WEB_SOURCE}/live/*.css ${STYLET_WEB_SOURCE}/shared/*)
set_property(GLOBAL PROPERTY STYLET_WEB_SOURCES ${STYLET_WEB_SOURCES})
add_custom_command(
  OUTPUT ${STYLET_WEB_BUILD}/packages.stamp
  COMMAND ${CMAKE_COMMAND} -DNPM=${NPM} -DSOURCE=${STYLET_WEB_SOURCE} -DBUILD=${STYLET_WEB_BUILD}
          -P ${STYLET_WEB_SOURCE}/fetch_packages.cmake
  DEPENDS ${STYLET_WEB_SOURCE}/package.json ${STYLET_WEB_SOURCE}/package-lock.json ${STYLET_WEB_SOURCE}/.npmrc
          ${STYLET_WEB_SOURCE}/fetch_packages.cmake
  COMMENT "Fetching the packages of the pages"
  VERBATIM)
# The build folder gets copies, so that packages are found beside them and the source tree stays clean.
add_custom_command(
  OUTPUT ${STYLET_WEB_BUILD}/sources.stamp
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${STYLET_WEB_SOURCE} -DBUILD=${STYLET_WEB_BUILD} -P ${STYLET_WEB_SOURCE}/copy_sources.cmake
  DEPENDS ${STYLET_WEB_SOURCES} ${STYLET_WEB_SOURCE}/tsconfig.json ${STYLET_WEB_SOURCE}/vite.config.ts
          ${STYLET_WEB_SOURCE}/copy_sources.cmake
  COMMENT "Copying the sources of the pages"
  VERBATIM)
add_custom_target(stylet_web DEPENDS ${STYLET_WEB_BUILD}/packages.stamp ${STYLET_WEB_BUILD}/sources.stamp)

function(stylet_web_pages)
  cmake_parse_arguments(W "" "FOLDER;OUTPUTS" "PAGES" ${ARGN})
  get_property(sources GLOBAL PROPERTY STYLET_WEB_SOURCES)
  list(FILTER sources INCLUDE REGEX "/web/(${W_FOLDER}|shared)/")
  set(outputs)
  foreach(page ${W_PAGES})
    add_custom_command(
      OUTPUT ${STYLET_WEB_BUILD}/dist/${page}.js ${STYLET_WEB_BUILD}/dist/${page}.css
      COMMAND ${NODE} node_modules/vite/bin/vite.js build --logLevel warn --mode ${page}
      DEPENDS stylet_web ${sources} ${STYLET_WEB_SOURCE}/package-lock.json ${STYLET_WEB_SOURCE}/tsconfig.json
              ${STYLET_WEB_SOURCE}/vite.config.ts
      WORKING_DIRECTORY ${STYLET_WEB_BUILD}
      COMMENT "Building the page ${page}"
      VERBATIM)
    list(APPEND outputs ${STYLET_WEB_BUILD}/dist/${page}.js ${STYLET_WEB_BUILD}/dist/${page}.css)
  endforeach()
  set(${W_OUTPUTS} ${outputs} PARENT_SCOPE)
endfunction()
