# The vcpkg port in packaging/, run with stand-ins for the functions of vcpkg that it calls; then the package it makes is
# found from a project. What vcpkg itself checks beyond that is not tested.
# cmake -D source=<repository> -D scratch=<folder to use> -D compiler=<C++ compiler> -D generator=<CMake generator>
#       -P check_vcpkg_port.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
set(CURRENT_PACKAGES_DIR ${scratch}/package)
set(build ${scratch}/build)

function(vcpkg_cmake_configure)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "SOURCE_PATH" "OPTIONS")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${arg_SOURCE_PATH} -B ${build} -G ${generator} ${arg_OPTIONS}
                          -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR}
                          -D CMAKE_INSTALL_MESSAGE=NEVER
                  COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_cmake_install)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${build} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(vcpkg_cmake_config_fixup)  # without arguments: it is where vcpkg wants it
  if(ARGC GREATER 0 OR NOT EXISTS ${CURRENT_PACKAGES_DIR}/share/surefoot/surefoot-config.cmake)
    message(FATAL_ERROR "vcpkg port: the package file is not in share/surefoot")
  endif()
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "FILE_LIST")
  file(COPY_FILE ${arg_FILE_LIST} ${CURRENT_PACKAGES_DIR}/share/surefoot/copyright)
endfunction()

include(${source}/packaging/vcpkg/surefoot/portfile.cmake)

file(READ ${source}/packaging/vcpkg/surefoot/vcpkg.json manifest)
string(JSON name GET "${manifest}" name)
file(GLOB_RECURSE left RELATIVE ${CURRENT_PACKAGES_DIR} ${CURRENT_PACKAGES_DIR}/*)
list(FILTER left EXCLUDE REGEX "^(include/${name}/.*\\.[hi]pp|share/${name}/[^/]*|share/pkgconfig/${name}\\.pc)$")
if(left)
  message(FATAL_ERROR "vcpkg port: files where vcpkg wants none: ${left}")
endif()
file(COPY ${source}/tests/consumers/fetch_content/main.cpp DESTINATION ${scratch}/project)
file(WRITE ${scratch}/project/CMakeLists.txt
     "cmake_minimum_required(VERSION 3.25)
project(from_vcpkg LANGUAGES CXX)
find_package(surefoot CONFIG REQUIRED)
add_executable(program main.cpp)
target_link_libraries(program PRIVATE surefoot::surefoot)
")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${scratch}/project -B ${scratch}/out -G ${generator}
                        -D CMAKE_CXX_COMPILER=${compiler} -D surefoot_DIR=${CURRENT_PACKAGES_DIR}/share/surefoot
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${scratch}/out COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${scratch}/out/program COMMAND_ERROR_IS_FATAL ANY)
