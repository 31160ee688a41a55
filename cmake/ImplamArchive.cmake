# The source archive: cpack --config build/CPackSourceConfig.cmake. It holds what git does not ignore, and a file with
# the commit, so that a program built without git still says what it was built from. It is made in the folder of the
# build: in that of the sources it would hold its own folder, and from the second time on itself.
set(CPACK_PACKAGE_NAME implam)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Implam developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR})
set(CPACK_SOURCE_PACKAGE_FILE_NAME implam-${PROJECT_VERSION})
string(REGEX REPLACE "([][+.*()^$?|\\])" "\\\\\\1" root ${CMAKE_SOURCE_DIR})
set(CPACK_SOURCE_IGNORE_FILES "/[.]git/" "/[.]git$" "^${root}/build[^/]*/" "^${root}/results/" "/[.]venv(/|$)"
  "/__pycache__/" "/[.]ruff_cache/" "[.]egg-info/" "/postproc/build/" "[.]swp$" "~$")
set(CPACK_INSTALL_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/ImplamArchivedCommit.cmake)
set(CPACK_IMPLAM_SOURCE_DIR ${CMAKE_SOURCE_DIR})
include(CPack)
