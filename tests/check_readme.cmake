# The README quotes examples/minimal/main.cpp word for word: cmake -D source=REPOSITORY -P check_readme.cmake
file(READ ${source}/README.md readme)
file(READ ${source}/examples/minimal/main.cpp example)
string(REGEX REPLACE ".*// \\[readme\\]\n(.*)// \\[readme\\].*" "\\1" quoted "${example}")
string(FIND "${readme}" "${quoted}" position)
if(quoted STREQUAL example OR position EQUAL -1)
  message(FATAL_ERROR "README.md must hold the lines of examples/minimal/main.cpp between its [readme] markers")
endif()
