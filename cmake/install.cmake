# `cmake --install`, the package file behind find_package(surefoot CONFIG), and that of pkg-config. Nothing is compiled
# for it, and what was installed can be moved.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_DATADIR}/surefoot)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/surefoot-config.cmake.in
                              ${PROJECT_BINARY_DIR}/surefoot-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/surefoot-config-version.cmake
                                 COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)

install(TARGETS surefoot EXPORT surefoot-targets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT surefoot-targets NAMESPACE surefoot:: DESTINATION ${package_dir})
install(FILES ${PROJECT_BINARY_DIR}/surefoot-config.cmake ${PROJECT_BINARY_DIR}/surefoot-config-version.cmake
        DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/surefoot DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(pkg_config_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH to_prefix /${pkg_config_dir} /)
string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})
set(pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
if(IS_ABSOLUTE ${CMAKE_INSTALL_INCLUDEDIR})
  set(pc_includedir ${CMAKE_INSTALL_INCLUDEDIR})
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/surefoot.pc.in ${PROJECT_BINARY_DIR}/surefoot.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/surefoot.pc DESTINATION ${pkg_config_dir})
