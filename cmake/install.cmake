# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the library (core…realtime) with its headers for find_package(stylet), and the stylet program.
include(CMakePackageConfigHelpers)
set(STYLET_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/stylet)

install(TARGETS stylet EXPORT stylet-targets)
foreach(module core geom fem needle coupling sim realtime)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/stylet/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stylet)
endforeach()
if(TARGET stylet_cli)
  install(TARGETS stylet_cli)
endif()

install(EXPORT stylet-targets NAMESPACE stylet:: DESTINATION ${STYLET_CMAKE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/stylet-config.cmake.in ${PROJECT_BINARY_DIR}/stylet-config.cmake
                              INSTALL_DESTINATION ${STYLET_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/stylet-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/stylet-config.cmake ${PROJECT_BINARY_DIR}/stylet-config-version.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindCholmod.cmake
        DESTINATION ${STYLET_CMAKE_DIR})
