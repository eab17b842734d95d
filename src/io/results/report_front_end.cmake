# SPDX-License-Identifier: GPL-3.0-or-later
# Puts the pages of web/report with their styles and scripts into the library stylet_report_assets.
include(${PROJECT_SOURCE_DIR}/web/front_end.cmake)
stylet_web_pages(FOLDER report PAGES report dose implant reproduce validate OUTPUTS report_outputs)
set(REPORT_TEMPLATE ${STYLET_WEB_SOURCE}/report/template.html)
set(DOSE_SHELL ${STYLET_WEB_SOURCE}/report/dose_shell.html)
set(DOSE_TEMPLATE ${STYLET_WEB_SOURCE}/report/dose.html)
set(IMPLANT_TEMPLATE ${STYLET_WEB_SOURCE}/report/implant.html)
set(REPRODUCE_TEMPLATE ${STYLET_WEB_SOURCE}/report/reproduce.html)
set(VALIDATE_TEMPLATE ${STYLET_WEB_SOURCE}/report/validate.html)
set(WEB_DIST ${STYLET_WEB_BUILD}/dist)

set(report_assets ${STYLET_WEB_BUILD}/report_assets.cpp)
configure_file(report/assets.cpp.in ${report_assets} @ONLY)
# Exclude the file from unity builds, because its dependencies would be lost in a joined file.
set_source_files_properties(${report_assets} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  OBJECT_DEPENDS
  "${report_outputs};${REPORT_TEMPLATE};${DOSE_SHELL};${DOSE_TEMPLATE};${IMPLANT_TEMPLATE};${REPRODUCE_TEMPLATE};${VALIDATE_TEMPLATE}")
add_library(stylet_report_assets STATIC ${report_assets} ${report_outputs})
target_include_directories(stylet_report_assets PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
