# `cmake --build BUILD --target debian_packages`: libsurefoot-dev for those who program, surefoot-tools for those who do not.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_CONTACT "the surefoot developers <surefoot@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_COMPONENTS_ALL headers compiled apps_library apps)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libsurefoot-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME surefoot-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)

include(CPack)
cpack_add_component_group(library DESCRIPTION "Headers, libraries, and files of CMake and pkg-config")
cpack_add_component_group(tools DESCRIPTION "surefoot-diagnose and surefoot-calibrate, with models to start from")
foreach(component headers compiled apps_library)
  cpack_add_component(${component} GROUP library)
endforeach()
cpack_add_component(apps GROUP tools)

add_custom_target(debian_packages COMMAND ${CMAKE_CPACK_COMMAND} -G DEB -B ${PROJECT_BINARY_DIR}/packages
                  DEPENDS surefoot_compiled surefoot_diagnose_files surefoot-diagnose surefoot-calibrate man_pages
                  WORKING_DIRECTORY ${PROJECT_BINARY_DIR} VERBATIM)
