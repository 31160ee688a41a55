# cmake --install: the program, its manual page and completions (written by the program itself, from its own tables),
# decks, manual, and what find_package(Implam) reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(pages ${CMAKE_BINARY_DIR}/pages)
file(MAKE_DIRECTORY ${pages})
add_custom_command(OUTPUT ${pages}/implam.1 ${pages}/implam ${pages}/_implam
  COMMAND implam man > ${pages}/implam.1
  COMMAND implam completion bash > ${pages}/implam
  COMMAND implam completion zsh > ${pages}/_implam
  DEPENDS implam VERBATIM COMMENT "Writing the manual page and the completions of shells")
add_custom_target(implam_pages ALL DEPENDS ${pages}/implam.1 ${pages}/implam ${pages}/_implam)

install(TARGETS implam EXPORT ImplamTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
set_target_properties(implam PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(FILES ${pages}/implam.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${pages}/implam DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${pages}/_implam DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(DIRECTORY input/ DESTINATION ${CMAKE_INSTALL_DATADIR}/implam/input)
install(DIRECTORY doc/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/doc PATTERN news EXCLUDE)
install(FILES README.md LICENSE CITATION.cff CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Implam)
configure_package_config_file(cmake/ImplamConfig.cmake.in ${CMAKE_BINARY_DIR}/ImplamConfig.cmake
  INSTALL_DESTINATION ${config} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/ImplamConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT ImplamTargets NAMESPACE Implam:: DESTINATION ${config})
install(FILES ${CMAKE_BINARY_DIR}/ImplamConfig.cmake ${CMAKE_BINARY_DIR}/ImplamConfigVersion.cmake
  DESTINATION ${config})
