# What tests, examples and benchmarks share; users of the library get none of it.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo or Debug" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_CXX_EXTENSIONS OFF)

# No contraction to fused multiply-add: a policy file has the same bits from every compiler and machine.
add_library(surefoot_own INTERFACE)
target_link_libraries(surefoot_own INTERFACE surefoot::compiled)
set(own_options -Wall -Wextra -Wpedantic -Wconversion -Werror -ffp-contract=off)
# GCC 12 sees overlapping memory in "x" + std::string (its bug 105651).
list(APPEND own_options $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# In std::stable_sort libstdc++ 12 calls what it has declared deprecated, which Clang 19 reports.
list(APPEND own_options $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)
# At -Og GCC takes a constructor that is given its own object for one that reads it (std::stop_source).
list(APPEND own_options $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:RelWithDebInfo>>:-Wno-maybe-uninitialized>)
target_compile_options(surefoot_own INTERFACE ${own_options})
target_compile_options(surefoot_compiled PRIVATE ${own_options})

# The files of a target some at a time, so that a header that many of them read is read and compiled once for all.
option(SUREFOOT_UNITY "Compile files of a target together: half the work from nothing, more of it after an edit" OFF)
function(surefoot_unity target files)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SUREFOOT_UNITY} UNITY_BUILD_BATCH_SIZE ${files})
endfunction()

# What computes for longer than it takes to compile may be optimised more than the rest of a build.
set(SUREFOOT_COMPUTING_OPTIONS "" CACHE STRING "Further options for programs and tests that compute for long")

surefoot_unity(surefoot_compiled 3)  # a user's build has the files one by one, for small computers

if(SUREFOOT_TIDY)
  find_program(SUREFOOT_CLANG_TIDY NAMES clang-tidy-19 clang-tidy)
  if(SUREFOOT_CLANG_TIDY)
    set(CMAKE_CXX_CLANG_TIDY ${SUREFOOT_CLANG_TIDY} --quiet)
  else()
    message(STATUS "surefoot: clang-tidy not found, building without it (package clang-tidy-19)")
  endif()
endif()
