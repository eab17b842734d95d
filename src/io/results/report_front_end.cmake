# SPDX-License-Identifier: GPL-3.0-or-later
# Puts the pages of web/report with their styles and scripts into the library stylet_report_assets.
include(${PROJECT_SOURCE_DIR}/web/front_end.cmake)
stylet_web_pages(FOLDER report PAGES report dose implant reproduce validate OUTPUTS report_outputs)
set(PAGES ${STYLET_WEB_SOURCE}/report)
file(GLOB report_html CONFIGURE_DEPENDS ${PAGES}/*.html)
set(WEB_DIST ${STYLET_WEB_BUILD}/dist)

set(report_assets ${STYLET_WEB_BUILD}/report_assets.cpp)
configure_file(report/assets.cpp.in ${report_assets} @ONLY)
# Exclude the file from unity builds, because its dependencies would be lost in a joined file.
set_source_files_properties(${report_assets} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  OBJECT_DEPENDS "${report_outputs};${report_html}")
add_library(stylet_report_assets STATIC ${report_assets} ${report_outputs})
target_include_directories(stylet_report_assets PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
