# Precompiled headers for our own programs: Eigen and what of the standard library nearly every file reads. They are a second
# of the two to four that most files take. Off unless asked for: GCC 12 raises false alarms about strings when the standard
# library comes out of one (its bugs 105329 and 105651); and a compiler cache does better without them.
option(SUREFOOT_PRECOMPILE "Precompile headers of our own programs" OFF)

# surefoot_precompile(TARGET [WITH HEADER_TARGET]): everything that links surefoot_own shares one precompiled header; WITH: the
# one of another target.
function(surefoot_precompile target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "WITH" "")
  if(NOT arg_WITH)
    set(arg_WITH surefoot_precompiled)
  endif()
  if(SUREFOOT_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${arg_WITH})
  endif()
endfunction()

# surefoot_precompiled_headers(NAME LIBRARY HEADER...): a target with a precompiled header, for what links LIBRARY. It is
# compiled in the same way but links nothing, or else everything would wait for all libraries.
function(surefoot_precompiled_headers name library)
  if(SUREFOOT_PRECOMPILE)
    file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${name}.cpp CONTENT "// CMake wants a source file beside the headers.\n")
    add_library(${name} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled/${name}.cpp)
    target_compile_features(${name} PRIVATE cxx_std_20)
    target_compile_options(${name} PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_COMPILE_OPTIONS>)
    target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_COMPILE_DEFINITIONS>)
    target_include_directories(${name} SYSTEM PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
endfunction()

set(often_included <Eigen/Dense> <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <iostream> <map>
                   <memory> <optional> <random> <span> <sstream> <string> <string_view> <thread> <tuple> <utility> <vector>)
surefoot_precompiled_headers(surefoot_precompiled surefoot_own ${often_included})
