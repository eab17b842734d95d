# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the library (core…realtime) with its headers for find_package(stylet), what reads and writes files for
# find_package(stylet COMPONENTS files), the library for C (stylet_rt) with its header, a pkg-config file and an example, and
# the stylet program.
include(CMakePackageConfigHelpers)
set(STYLET_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/stylet)

install(TARGETS stylet EXPORT stylet-targets)
foreach(module core geom dose fem needle coupling sim probe imaging realtime)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/stylet/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stylet)
endforeach()
# The component `files`: from a patient's file to a result folder. Its libraries are static, so who links them needs
# the libraries of the formats (VTK, DCMTK, CGAL, HDF5, …) as well; stylet-config.cmake finds them.
if(TARGET stylet_patient)
  install(TARGETS stylet_patient stylet_implant stylet_io stylet_model_file stylet_mesher stylet_phantom stylet_report_assets
          EXPORT stylet-files-targets)
  foreach(module implant io mesher patient phantom)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/stylet/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stylet)
  endforeach()
  install(EXPORT stylet-files-targets NAMESPACE stylet:: DESTINATION ${STYLET_CMAKE_DIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/stylet/examples
          FILES_MATCHING PATTERN "*.cpp")
endif()
if(TARGET stylet_rt)
  install(TARGETS stylet_rt EXPORT stylet-targets)
  install(FILES ${PROJECT_SOURCE_DIR}/include/stylet/stylet_rt.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stylet)
  # Found from where the file itself is, so that an installed tree can be moved.
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
             OUTPUT_VARIABLE STYLET_PC_TO_PREFIX)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/stylet_rt.pc.in ${PROJECT_BINARY_DIR}/stylet_rt.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/stylet_rt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  install(FILES ${PROJECT_SOURCE_DIR}/examples/rt_loop.c ${PROJECT_SOURCE_DIR}/examples/three_needles.c DESTINATION ${CMAKE_INSTALL_DATADIR}/stylet/examples)
endif()
if(TARGET stylet_reader)
  install(TARGETS stylet_reader DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/stylet)
endif()
if(TARGET stylet_cli)
  install(TARGETS stylet_cli)
endif()

install(EXPORT stylet-targets NAMESPACE stylet:: DESTINATION ${STYLET_CMAKE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/stylet-config.cmake.in ${PROJECT_BINARY_DIR}/stylet-config.cmake
                              INSTALL_DESTINATION ${STYLET_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/stylet-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/stylet-config.cmake ${PROJECT_BINARY_DIR}/stylet-config-version.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindCholmod.cmake ${CMAKE_CURRENT_LIST_DIR}/FindMetis.cmake
        DESTINATION ${STYLET_CMAKE_DIR})
