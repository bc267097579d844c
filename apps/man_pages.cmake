# A page of the manual for each program that is installed, made from what it says for --help.
set(man_pages)
foreach(program surefoot-diagnose surefoot-calibrate)
  set(page ${CMAKE_CURRENT_BINARY_DIR}/man/${program}.1.gz)
  add_custom_command(OUTPUT ${page}
                     COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/man_page.sh $<TARGET_FILE:${program}> ${page}
                     DEPENDS ${program} man_page.sh VERBATIM)
  list(APPEND man_pages ${page})
endforeach()
add_custom_target(man_pages ALL DEPENDS ${man_pages})
