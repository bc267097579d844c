# The component apps: programs, their pages of the manual, models to start from. The component apps_library: what they
# share, for a simulator in C++ that wants their command line.
surefoot_install_target(surefoot_diagnose_files apps_library surefoot-apps)
install(DIRECTORY include/surefoot_apps DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT apps_library)

install(TARGETS surefoot-diagnose surefoot-calibrate COMPONENT apps)
install(FILES ${man_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT apps)
install(DIRECTORY diagnose/models DESTINATION ${package_dir} COMPONENT apps FILES_MATCHING PATTERN "*.toml")
