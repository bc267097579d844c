# Makes both Debian packages of what is built, installs them into an empty root, runs a diagnosis there, and builds programs
# from there that see nothing of the repository.
# cmake -D build=<build folder> -D cpack=<CPack> -D version=<of surefoot> -D scratch=<folder to use> -D source=<repository>
#       -D compiler=<C++ compiler> -D launcher=<say ccache, or empty> -D generator=<CMake generator> -D flags=<of the compiler>
#       -P check_debian_packages.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${scratch})
set(root ${scratch}/root)
file(MAKE_DIRECTORY ${root}/var/lib/dpkg/info ${root}/var/lib/dpkg/updates)
file(TOUCH ${root}/var/lib/dpkg/status)
execute_process(COMMAND ${cpack} -G DEB --config ${build}/CPackConfig.cmake -B ${scratch}/packages OUTPUT_QUIET
                COMMAND_ERROR_IS_FATAL ANY)

# As dpkg itself installs them, where it may; else unpacked.
execute_process(COMMAND id -u OUTPUT_VARIABLE user OUTPUT_STRIP_TRAILING_WHITESPACE)
foreach(package libsurefoot-dev surefoot-tools)
  file(GLOB deb ${scratch}/packages/${package}_${version}_*.deb)
  if(NOT deb)
    message(FATAL_ERROR "debian packages: CPack made no ${package}_${version}_*.deb")
  endif()
  set(failed 1)
  if(user EQUAL 0)
    execute_process(COMMAND dpkg --root=${root} --force-depends --install ${deb} OUTPUT_QUIET ERROR_QUIET
                    RESULT_VARIABLE failed)
  endif()
  if(failed)
    execute_process(COMMAND dpkg-deb -x ${deb} ${root} COMMAND_ERROR_IS_FATAL ANY)
  endif()
  execute_process(COMMAND dpkg-deb -f ${deb} Depends OUTPUT_VARIABLE depends_${package} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(NOT depends_libsurefoot-dev MATCHES "libeigen3-dev" OR NOT depends_surefoot-tools MATCHES "libstdc")
  message(FATAL_ERROR "debian packages: they depend on too little: ${depends_libsurefoot-dev} and ${depends_surefoot-tools}")
endif()

# The programs, with nothing but what is in the root.
execute_process(COMMAND ${root}/usr/bin/surefoot-diagnose --version OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT said STREQUAL "surefoot-diagnose ${version}")
  message(FATAL_ERROR "debian packages: surefoot-diagnose --version says: ${said}")
endif()
foreach(page surefoot-diagnose surefoot-calibrate)
  if(NOT EXISTS ${root}/usr/share/man/man1/${page}.1.gz)
    message(FATAL_ERROR "debian packages: no page of the manual for ${page}")
  endif()
endforeach()

# Recordings of a servo that swings a weight with dry friction, and of a DC motor that hears its input 30 ms late; their models
# know neither.
set(recordings)
foreach(number RANGE 1 6)
  execute_process(
    COMMAND awk -v seed=${number} "BEGIN {
      srand(seed)
      print \"# mass_kg: 0.5\\n# length_m: 0.1\\n# kp: 5\\n# vin_V: 7.4\\nt_s,goal_rad,theta_rad,u_norm,speed_sensor_V\"
      theta = 0.01; omega = goal = speed = 0
      for (row = 0; row < 400; ++row) {
        if (row % 40 == 0) goal = 2 * rand() - 1
        drive[row] = goal
        printf \"%.3f,%.4f,%.5f,%.4f,%.5f\\n\", row * 0.01, goal, theta + 0.001 * (2 * rand() - 1), goal, speed + 0.01 * (2 * rand() - 1)
        for (i = 0; i < 20; ++i) {
          duty = 5 * (goal - theta); if (duty > 1) duty = 1; if (duty < -1) duty = -1
          dry = 0.4 * omega / (0.001 + sqrt(omega * omega))
          omega += 0.0005 * (1.6 / 3.6 * (7.4 * duty - 1.6 * omega) - dry - 0.4905 * sin(theta)) / 0.017
          theta += 0.0005 * omega
          speed += 0.0005 * (60 * (row < 3 ? 0 : drive[row - 3]) - 5 * speed)
        }
      }
    }"
    OUTPUT_FILE ${scratch}/recording_${number}.csv COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND recordings ${scratch}/recording_${number}.csv)
endforeach()

# check_diagnosis(EFFECT COMMAND...): the diagnosis names that effect alone, and leaves a report.
function(check_diagnosis effect)
  execute_process(COMMAND ${ARGN} --out ${scratch}/report --effects coulomb_friction,input_delay --quiet ${recordings}
                  COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${scratch}/report/diagnosis.json diagnosis)
  string(JSON effects GET "${diagnosis}" effects)
  string(JSON count LENGTH "${effects}")
  string(JSON found ERROR_VARIABLE none GET "${effects}" 0 name)
  if(NOT count EQUAL 1 OR NOT found STREQUAL effect OR NOT EXISTS ${scratch}/report/report.html)
    message(FATAL_ERROR "debian packages: ${ARGN} must find ${effect}, not: ${effects}")
  endif()
  file(REMOVE_RECURSE ${scratch}/report)
endfunction()
check_diagnosis(input_delay ${root}/usr/bin/surefoot-diagnose
                --model ${root}/usr/share/surefoot/models/hoop_motor.toml)

# Programs of others.
file(COPY ${source}/tests/consumers/debian_packages DESTINATION ${scratch})
file(COPY_FILE ${source}/tests/consumers/fetch_content/main.cpp ${scratch}/debian_packages/header_only.cpp)
file(COPY_FILE ${source}/examples/diagnose_own/main.cpp ${scratch}/debian_packages/own_simulator.cpp)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${scratch}/debian_packages -B ${scratch}/build -G ${generator}
                        -D CMAKE_PREFIX_PATH=${root}/usr -D CMAKE_CXX_COMPILER=${compiler}
                        -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher} "-DCMAKE_CXX_FLAGS=-O1 ${flags}"
                        -D CMAKE_EXPORT_COMPILE_COMMANDS=ON
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${scratch}/build COMMAND_ERROR_IS_FATAL ANY)
foreach(program header_only compiled)
  execute_process(COMMAND ${scratch}/build/${program} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
check_diagnosis(coulomb_friction ${scratch}/build/own_simulator)

file(READ ${scratch}/build/compile_commands.json commands)
string(REPLACE "${scratch}/" "" commands "${commands}")
foreach(folder "${source}/include" "${source}/apps")
  string(FIND "${commands}" "${folder}" position)
  if(NOT position EQUAL -1)
    message(FATAL_ERROR "debian packages: programs of others are compiled with a path into the repository:\n${commands}")
  endif()
endforeach()
