# Installs surefoot without building anything, and moves what was installed: the tests of outside use start from there.
# cmake -D source=<repository> -D scratch=<folder to use> -D compiler=<C++ compiler> -D generator=<CMake generator>
#       -P check_install.cmake
# Fails if anything installed names a folder of this machine. Leaves the package in <scratch>/prefix.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${scratch}/build -G ${generator}
                        -D CMAKE_CXX_COMPILER=${compiler}
                        -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=OFF -D SUREFOOT_BENCHMARKS=OFF -D CMAKE_INSTALL_MESSAGE=NEVER
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${scratch}/build --prefix ${scratch}/first COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${scratch}/first ${scratch}/prefix)

file(GLOB_RECURSE installed RELATIVE ${scratch}/prefix ${scratch}/prefix/*)
foreach(wanted include/surefoot/surefoot.hpp include/surefoot/version.hpp share/surefoot/surefoot-config.cmake
               share/pkgconfig/surefoot.pc)
  if(NOT wanted IN_LIST installed)
    message(FATAL_ERROR "install: ${wanted} is missing from what was installed")
  endif()
endforeach()
foreach(file IN LISTS installed)
  file(READ ${scratch}/prefix/${file} text)
  foreach(folder ${source} ${scratch})
    string(FIND "${text}" "${folder}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "install: ${file} names ${folder}, so it cannot be moved to another machine")
    endif()
  endforeach()
endforeach()
list(LENGTH installed count)
message(STATUS "${count} files installed")
