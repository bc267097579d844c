# surefoot::compiled: the headers with everything that does not depend on types of the user compiled once. Its sources
# are the same files: one translation unit per folder of include/surefoot, of all its .ipp.
file(GLOB_RECURSE definitions CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include
     ${PROJECT_SOURCE_DIR}/include/surefoot/*.ipp)
set(folders)
foreach(file IN LISTS definitions)
  get_filename_component(folder ${file} DIRECTORY)
  list(APPEND folders ${folder})
  string(MAKE_C_IDENTIFIER ${folder} id)
  string(APPEND text_${id} "#include \"${file}\"\n")
endforeach()
list(REMOVE_DUPLICATES folders)
set(sources)
foreach(folder IN LISTS folders)
  string(MAKE_C_IDENTIFIER ${folder} id)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/compiled/${id}.cpp CONTENT "${text_${id}}")
  list(APPEND sources ${PROJECT_BINARY_DIR}/compiled/${id}.cpp)
endforeach()

add_library(surefoot_compiled STATIC ${sources})
add_library(surefoot::compiled ALIAS surefoot_compiled)
set_target_properties(surefoot_compiled PROPERTIES OUTPUT_NAME surefoot EXPORT_NAME compiled POSITION_INDEPENDENT_CODE ON)
target_link_libraries(surefoot_compiled PUBLIC surefoot)
# The library and a program with other -march flags agree on how memory is aligned.
target_compile_definitions(surefoot_compiled PUBLIC SUREFOOT_COMPILED EIGEN_MAX_ALIGN_BYTES=16)
# Tests spend their time in the library: the more it is optimised, the sooner they end, although they are not.
set(SUREFOOT_COMPILED_OPTIONS "" CACHE STRING "Further options to compile surefoot::compiled with")
target_compile_options(surefoot_compiled PRIVATE ${SUREFOOT_COMPILED_OPTIONS})
# No contraction to fused multiply-add: the same results on every machine.
target_compile_options(surefoot_compiled PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)

# Where nothing of our own needs it and it is not installed, it is built only if something links it.
if(NOT SUREFOOT_INSTALL_COMPILED)
  set_target_properties(surefoot_compiled PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
