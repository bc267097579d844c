# Builds a project that uses surefoot in a folder of its own, and runs its tests.
# cmake -D project=<its folder> -D scratch=<folder to use> -D compiler=<C++ compiler> -D launcher=<say ccache, or empty>
#       -D generator=<CMake generator> -D source=<repository> -D flags=<of the compiler> -P check_consumer.cmake, with one of
#   -D prefix=<where surefoot is installed>  then fails if anything is compiled with a path into the repository
#   -D fetch=ON                              as a part of the project, from the repository
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
get_filename_component(name ${project} NAME)
file(COPY ${project} DESTINATION ${scratch})
if(fetch)
  set(where -D FETCHCONTENT_SOURCE_DIR_SUREFOOT=${source})
else()
  set(where -D CMAKE_PREFIX_PATH=${prefix})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -S ${scratch}/${name} -B ${scratch}/build -G ${generator} ${where}
                        -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher}
                        "-DCMAKE_CXX_FLAGS=-O1 ${flags}" -D CMAKE_EXPORT_COMPILE_COMMANDS=ON
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${scratch}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${scratch}/build --output-on-failure --no-tests=error
                COMMAND_ERROR_IS_FATAL ANY)

file(READ ${scratch}/build/compile_commands.json commands)
if(fetch)
  file(GLOB_RECURSE objects ${scratch}/build/*.o)
  list(LENGTH objects count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "${name}: ${count} files are compiled, expected its own one: surefoot must bring only headers")
  endif()
  string(JSON last LENGTH "${commands}")
  math(EXPR last "${last} - 1")
  foreach(i RANGE ${last})
    string(JSON file GET "${commands}" ${i} file)
    if(file MATCHES "/${name}/main\\.cpp$")
      string(JSON command GET "${commands}" ${i} command)
    endif()
  endforeach()
  if(command MATCHES " (-W[^ ]*|-ffp[^ ]*|-Dsurefoot[^ ]*|-DSUREFOOT[^ ]*)")
    message(FATAL_ERROR "${name}: surefoot forces ${CMAKE_MATCH_1} on projects that use it")
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${scratch}/build --prefix ${scratch}/installed
                  COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB_RECURSE installed RELATIVE ${scratch}/installed ${scratch}/installed/*)
  if(NOT installed STREQUAL "bin/${name}")
    message(FATAL_ERROR "${name}: surefoot adds itself to what the project installs: ${installed}")
  endif()
else()
  string(FIND "${commands}" "${prefix}/include" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "${name}: nothing is compiled with the headers of ${prefix}")
  endif()
  string(REPLACE "${prefix}/" "" rest "${commands}")
  string(REPLACE "${scratch}/" "" rest "${rest}")
  string(FIND "${rest}" "${source}/" position)
  if(NOT position EQUAL -1)
    message(FATAL_ERROR "${name}: compiled with a path into ${source}:\n${commands}")
  endif()
endif()
