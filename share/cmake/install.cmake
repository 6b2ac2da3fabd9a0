# cmake --install: programs, libraries, headers, data, documents, package files for CMake and pkg-config, files for systemd.
# (The LCM types and their bindings are installed by share/lcm, the public headers by share/include.)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY TAKT_LIBRARIES)
install(TARGETS ${libraries} EXPORT takt-targets)
set(programs takt taktd takt-follow takt-home takt-jog takt-logic takt-move)
install(TARGETS ${programs})

install(PROGRAMS apps/python/axes.py apps/python/first_bus.py apps/python/first_motion.py apps/python/first_speed.py
                 apps/python/motion.py
        DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/python)
install(FILES apps/python/takt_axes.py DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/python)
install(DIRECTORY apps/python/takt DESTINATION ${CMAKE_INSTALL_DATADIR}/takt/python PATTERN __pycache__ EXCLUDE)
install(DIRECTORY share/devices share/eds share/demo DESTINATION ${CMAKE_INSTALL_DATADIR}/takt)

# The pages link only to each other and to CHANGELOG.md. CHANGELOG.md is installed beside the pages, so the installed index has
# another link to this file. With COMPONENT, the pages can be installed without a build.
install(DIRECTORY share/doc/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc
        FILES_MATCHING PATTERN *.md PATTERN *.svg PATTERN index.md EXCLUDE)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS share/doc/index.md)
file(READ share/doc/index.md index_page)
string(REPLACE "(../../CHANGELOG.md)" "(CHANGELOG.md)" index_page "${index_page}")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/index.md "${index_page}")
install(FILES LICENSE CHANGELOG.md ${CMAKE_CURRENT_BINARY_DIR}/index.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)

# The schema and the manual pages, which the programs write. If takt is built for another architecture,
# CMAKE_CROSSCOMPILING_EMULATOR runs the programs.
set(written ${PROJECT_BINARY_DIR}/written)
file(MAKE_DIRECTORY ${written}/manual)
add_custom_command(OUTPUT ${written}/network.schema.json DEPENDS takt
                   COMMAND takt reference network-file --json-schema > ${written}/network.schema.json)
set(first_pages "")
foreach(program IN LISTS programs)
  set(page ${written}/manual/${program}.1)
  if(program STREQUAL "taktd")
    set(page ${written}/manual/taktd.8)
  endif()
  add_custom_command(OUTPUT ${page} DEPENDS ${program} COMMAND ${program} --manual ${written}/manual)
  list(APPEND first_pages ${page})
endforeach()
add_custom_target(takt_written ALL DEPENDS ${written}/network.schema.json ${first_pages})
install(FILES ${written}/network.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/takt)
foreach(section 1 8)
  install(DIRECTORY ${written}/manual/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} FILES_MATCHING PATTERN "*.${section}")
endforeach()

# bash and fish look for a file with the name of the program.
foreach(program IN LISTS programs)
  install(FILES share/completions/takt.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
  install(FILES share/completions/takt.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME ${program}.fish)
endforeach()
install(FILES share/completions/_takt DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)

# systemd reads lib/systemd below /usr and below /usr/local. A Debian package has its units in /lib/systemd.
set(TAKT_SYSTEMD_DIR lib/systemd CACHE PATH "Folder of the unit and of the .link file, below the prefix or absolute")
install(FILES share/systemd/taktd@.service DESTINATION ${TAKT_SYSTEMD_DIR}/system)
install(FILES share/systemd/60-takt-can.link DESTINATION ${TAKT_SYSTEMD_DIR}/network)
install(FILES share/systemd/takt.conf DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/security/limits.d)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/takt)
install(EXPORT takt-targets NAMESPACE takt:: DESTINATION ${package_dir})
configure_package_config_file(share/cmake/takt-config.cmake.in takt-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(takt-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/takt-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/takt-config-version.cmake
        DESTINATION ${package_dir})

# A static library comes before the libraries that it needs, in the reverse order of their definitions.
list(REVERSE libraries)
set(TAKT_PC_LIBS "")
foreach(library IN LISTS libraries)
  get_target_property(type ${library} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    string(APPEND TAKT_PC_LIBS " -l${library}")
  endif()
endforeach()
file(RELATIVE_PATH TAKT_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(share/cmake/takt.pc.in takt.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/takt.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
