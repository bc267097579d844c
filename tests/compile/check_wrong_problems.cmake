# cmake -D compiler=... -D include=dir;dir -D scratch=dir -P check_wrong_problems.cmake
# A problem or motion model that lacks a member, or has a wrong one, must give one error of a few lines that names the member.
set(most_lines 10)  # apart from those that say how the header came to be included
list(TRANSFORM include PREPEND -isystem)
list(TRANSFORM include REPLACE "^-isystem(.*/include)$" "-I\\1" AT 0)

# The headers that the sources are about, precompiled: they are read some thirty times.
function(precompile)
  list(TRANSFORM ARGN REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE lines)
  list(JOIN lines "" text)
  set(file ${scratch}/headers.hpp)
  file(WRITE ${file} "${text}")
  if(compiler MATCHES "clang")
    set(target ${scratch}/headers.pch)
    set(use -include-pch ${target})
  else()
    set(target ${file}.gch)
    set(use -include ${file})
  endif()
  execute_process(COMMAND ${compiler} -std=c++20 -DSUREFOOT_COMPILED ${include} -x c++-header ${file} -o ${target}
                  COMMAND_ERROR_IS_FATAL ANY)
  set(precompiled ${use} PARENT_SCOPE)
endfunction()

function(compile result output)
  list(TRANSFORM ARGN PREPEND -D)
  execute_process(COMMAND ${compiler} -std=c++20 -fsyntax-only -DSUREFOOT_COMPILED ${precompiled} ${include} ${ARGN}
                          ${CMAKE_CURRENT_LIST_DIR}/${source}
                  RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(${result} ${status} PARENT_SCOPE)
  set(${output} "${text}" PARENT_SCOPE)
endfunction()

function(expect_right)
  compile(status output ${ARGN})
  if(NOT status EQUAL 0)
    message(SEND_ERROR "the right problem does not compile (${ARGN}):\n${output}")
  endif()
endfunction()

function(expect_error_about member)
  compile(status output ${ARGN})
  string(REGEX MATCHALL "[^\n]*error: [^\n]*" errors "${output}")
  string(REGEX REPLACE "(In file included| +)from [^\n]*\n" "" message "${output}")
  string(REGEX MATCHALL "\n" lines "${message}")
  list(LENGTH errors error_count)
  list(LENGTH lines line_count)
  if(status EQUAL 0)
    message(SEND_ERROR "a wrong problem compiles (${ARGN})")
  elseif(NOT error_count EQUAL 1 OR NOT errors MATCHES "['‘]${member}['’]" OR line_count GREATER most_lines)
    message(SEND_ERROR "${ARGN}: ${line_count} lines (at most ${most_lines}), ${error_count} errors (one, about ${member}):\n"
                       "${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${scratch})
precompile(surefoot/core/rollout.hpp surefoot/core/validate.hpp surefoot/solve/rfpi.hpp surefoot/motion/calibrate.hpp)
set(source wrong_problem.cpp)
foreach(entry RFPI VALIDATE COMPARE EVALUATE)
  expect_right(${entry})
  expect_error_about(step ${entry} WRONG_step=0)
endforeach()
foreach(how 1 2 3)
  expect_error_about(step EVALUATE WRONG_step=${how})
endforeach()
expect_right(EVALUATE FEATURES=3)
foreach(wrong FEATURES=2 WRONG_features)
  expect_error_about(features EVALUATE ${wrong})
endforeach()
foreach(member state_dim action_dim State Action state_box action_box initial_state call_operator reset)
  expect_error_about(${member} EVALUATE WRONG_${member})
endforeach()

# A motion model likewise.
set(source wrong_model.cpp)
expect_right()
foreach(member default_constructor parameter_count parameter_info from_parameters parameters displacement)
  expect_error_about(${member} WRONG_${member})
endforeach()
