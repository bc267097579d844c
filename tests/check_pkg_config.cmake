# Builds and runs a program with nothing but a compiler and pkg-config, against an installed surefoot.
# cmake -D pkg_config=<program> -D prefix=<where surefoot is installed> -D main=<source file> -D scratch=<folder to use>
#       -D compiler=<C++ compiler> -D version=<of surefoot> -P check_pkg_config.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
file(MAKE_DIRECTORY ${scratch})
file(COPY_FILE ${main} ${scratch}/main.cpp)
set(ENV{PKG_CONFIG_PATH} ${prefix}/share/pkgconfig:$ENV{PKG_CONFIG_PATH})
execute_process(COMMAND ${pkg_config} --modversion surefoot OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT found STREQUAL version)
  message(FATAL_ERROR "pkg-config: surefoot has version ${found}, expected ${version}")
endif()
execute_process(COMMAND ${pkg_config} --cflags --libs surefoot OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
execute_process(COMMAND ${compiler} -std=c++20 main.cpp ${flags} -o program WORKING_DIRECTORY ${scratch}
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${scratch}/program COMMAND_ERROR_IS_FATAL ANY)
