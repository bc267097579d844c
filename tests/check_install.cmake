# Installs surefoot to a scratch folder, then builds and runs examples/cmake_project against it from outside.
# cmake -D build=<our build folder> -D project=<examples/cmake_project> -D compiler=<C++ compiler>
#       -D generator=<CMake generator> -D scratch=<folder to use> -P check_install.cmake
file(REMOVE_RECURSE ${scratch})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${build} --prefix ${scratch}/prefix COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${project} -B ${scratch}/build -G ${generator}
                        -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${scratch}/prefix
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${scratch}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${scratch}/build/first_step COMMAND_ERROR_IS_FATAL ANY)
