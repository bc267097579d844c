# All of surefoot in one header: made twice, the same bytes; then compiled and run away from the repository.
# cmake -D source=<repository> -D scratch=<folder to use> -D compiler=<C++ compiler> -D launcher=<say ccache, or empty>
#       -D eigen=<folders of Eigen> -D nm=<lists symbols> -P check_single_header.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
file(MAKE_DIRECTORY ${scratch})
foreach(header surefoot.hpp again.hpp)
  execute_process(COMMAND ${source}/packaging/amalgamate.sh ${scratch}/${header} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(SHA256 ${scratch}/surefoot.hpp one)
file(SHA256 ${scratch}/again.hpp two)
if(NOT one STREQUAL two)
  message(FATAL_ERROR "single header: two runs of packaging/amalgamate.sh differ")
endif()
file(STRINGS ${scratch}/surefoot.hpp ours REGEX "^#include \"")
if(ours)
  message(FATAL_ERROR "single header: it still includes others: ${ours}")
endif()

file(COPY_FILE ${source}/tests/consumers/single_header/main.cpp ${scratch}/main.cpp)
list(TRANSFORM eigen PREPEND -isystem)
execute_process(COMMAND ${launcher} ${compiler} -std=c++20 -O0 -g0 -Wall -Wextra -Werror ${eigen} -c main.cpp -o main.o
                WORKING_DIRECTORY ${scratch} COMMAND_ERROR_IS_FATAL ANY)
# Two files of one program may include it: all that it defines may be there twice. T, D, B: may not.
execute_process(COMMAND ${nm} --defined-only --extern-only --demangle main.o OUTPUT_VARIABLE symbols
                WORKING_DIRECTORY ${scratch} COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE ";" "," symbols "${symbols}")
string(REGEX MATCHALL "[0-9a-f]+ [TDBR] [^\n]+" symbols "${symbols}")
list(FILTER symbols EXCLUDE REGEX " T main$")
if(symbols)
  list(JOIN symbols "\n  " symbols)
  message(FATAL_ERROR "single header: not inline, so that two files cannot include it:\n  ${symbols}")
endif()
execute_process(COMMAND ${compiler} main.o -o program -pthread WORKING_DIRECTORY ${scratch} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${scratch}/program COMMAND_ERROR_IS_FATAL ANY)
