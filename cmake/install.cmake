# `cmake --install`, the package behind find_package(surefoot CONFIG), and those of pkg-config; what was installed can be
# moved. Components: headers (nothing is compiled for it), compiled (libsurefoot.a), apps_library (libsurefoot_apps.a) and
# apps (programs, their pages and models).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_DATADIR}/surefoot)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/surefoot-config.cmake.in
                              ${PROJECT_BINARY_DIR}/surefoot-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/surefoot-config-version.cmake
                                 COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)

# surefoot_install_target(TARGET COMPONENT PKG_CONFIG_FILE): a target, the file of the package that has it, and its .pc.
# Each component has a file of its own, because not all of them need to be there.
function(surefoot_install_target target component pc)
  install(TARGETS ${target} EXPORT ${component} COMPONENT ${component}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT ${component} NAMESPACE surefoot:: FILE surefoot-${component}.cmake DESTINATION ${package_dir}
          COMPONENT ${component})

  set(pc_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
  file(RELATIVE_PATH to_prefix /${pc_dir} /)
  string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})
  foreach(dir includedir libdir)
    string(TOUPPER CMAKE_INSTALL_${dir} variable)
    set(pc_${dir} "\${prefix}/${${variable}}")
    if(IS_ABSOLUTE ${${variable}})
      set(pc_${dir} ${${variable}})
    endif()
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${pc}.pc.in ${PROJECT_BINARY_DIR}/${pc}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${pc}.pc DESTINATION ${pc_dir} COMPONENT ${component})
endfunction()

surefoot_install_target(surefoot headers surefoot)
install(FILES ${PROJECT_BINARY_DIR}/surefoot-config.cmake ${PROJECT_BINARY_DIR}/surefoot-config-version.cmake
        DESTINATION ${package_dir} COMPONENT headers)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/surefoot DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT headers
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.ipp")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT headers)

if(SUREFOOT_INSTALL_COMPILED)
  surefoot_install_target(surefoot_compiled compiled surefoot-compiled)
endif()
