# Run by cpack: writes the commit into the archive of the source, where ImplamProvenance finds it without git.
if(CPACK_SOURCE_INSTALLED_DIRECTORIES OR CPACK_INSTALLED_DIRECTORIES)
  find_program(GIT git)
  set(commit "")
  if(GIT)
    execute_process(COMMAND ${GIT} describe --always --abbrev=12 --exclude=* --dirty=-modified
      WORKING_DIRECTORY ${CPACK_IMPLAM_SOURCE_DIR} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
  if(commit)
    file(WRITE ${CMAKE_INSTALL_PREFIX}/COMMIT "${commit}\n")
  endif()
endif()
