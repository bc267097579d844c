# An overlay port: installs the checkout that it lies in. Headers only, so there is nothing to build in two ways.
set(VCPKG_BUILD_TYPE release)
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    -DSUREFOOT_TESTS=OFF
    -DSUREFOOT_APPS=OFF
    -DSUREFOOT_EXAMPLES=OFF
    -DSUREFOOT_BENCHMARKS=OFF
    -DSUREFOOT_INSTALL_COMPILED=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup()
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/share/doc")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
