# SPDX-License-Identifier: GPL-3.0-or-later
# Embeds the page of web/live, its style and its script into the library stylet_live_assets.
include(${PROJECT_SOURCE_DIR}/web/front_end.cmake)
stylet_web_pages(FOLDER live PAGES live OUTPUTS live_outputs)
set(LIVE_PAGE ${STYLET_WEB_SOURCE}/live/index.html)
set(WEB_DIST ${STYLET_WEB_BUILD}/dist)

set(live_assets ${STYLET_WEB_BUILD}/live_assets.cpp)
configure_file(${CMAKE_CURRENT_LIST_DIR}/assets.cpp.in ${live_assets} @ONLY)
# No unity build: a file joined of several would lose these dependencies.
set_source_files_properties(${live_assets} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  OBJECT_DEPENDS "${live_outputs};${LIVE_PAGE}")
add_library(stylet_live_assets STATIC ${live_assets} ${live_outputs})
target_include_directories(stylet_live_assets PRIVATE ${CMAKE_CURRENT_LIST_DIR})
