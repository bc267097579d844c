# Installs the headers without building anything, and the libraries that are built if there are any, then moves what was
# installed: the tests of outside use start from there.
# cmake -D source=<repository> -D scratch=<folder to use> -D compiler=<C++ compiler> -D generator=<CMake generator>
#       [-D build=<build folder> -D components=<what of it to install>] -P check_install.cmake
# Fails if anything installed names a folder of this machine. Leaves the package in <scratch>/prefix.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${scratch}/build -G ${generator} -D CMAKE_CXX_COMPILER=${compiler}
                        -D SUREFOOT_TESTS=OFF -D SUREFOOT_APPS=OFF -D SUREFOOT_EXAMPLES=OFF -D SUREFOOT_BENCHMARKS=OFF
                        -D SUREFOOT_INSTALL_COMPILED=OFF -D CMAKE_INSTALL_MESSAGE=NEVER
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${scratch}/build --prefix ${scratch}/first COMMAND_ERROR_IS_FATAL ANY)
foreach(component ${components})
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${build} --prefix ${scratch}/first --component ${component}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME ${scratch}/first ${scratch}/prefix)

# Every header and every file of definitions, and the package files.
file(GLOB_RECURSE wanted RELATIVE ${source} ${source}/include/*.hpp ${source}/include/*.ipp)
list(APPEND wanted share/surefoot/surefoot-config.cmake share/pkgconfig/surefoot.pc)
if("apps" IN_LIST components)
  list(APPEND wanted bin/surefoot-diagnose share/man/man1/surefoot-diagnose.1.gz share/surefoot/models/hoop_motor.toml)
endif()
file(GLOB_RECURSE installed RELATIVE ${scratch}/prefix ${scratch}/prefix/*)
foreach(file IN LISTS wanted)
  if(NOT file IN_LIST installed)
    message(FATAL_ERROR "install: ${file} is missing from what was installed")
  endif()
endforeach()
# Programs and libraries may name source files, for debuggers.
list(FILTER installed EXCLUDE REGEX "^bin/|\\.a$|\\.gz$")
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
message(STATUS "${count} files installed, beside programs and libraries")
