# What a program was built from, in the generated Fortran module build_information.
# Included while configuring it defines implam_add_provenance; run as a script (cmake -P) at
# each build it renews the module, which is rewritten only when something in it has changed.

if(CMAKE_SCRIPT_MODE_FILE)
  set(IMPLAM_COMMIT "unknown")
  if(EXISTS ${IMPLAM_SOURCE_DIR}/COMMIT) # in an archive of the source
    file(STRINGS ${IMPLAM_SOURCE_DIR}/COMMIT IMPLAM_COMMIT LIMIT_COUNT 1)
  endif()
  find_program(GIT git)
  if(GIT AND EXISTS ${IMPLAM_SOURCE_DIR}/.git)
    execute_process(COMMAND ${GIT} describe --always --abbrev=12 --exclude=* --dirty=-modified
      WORKING_DIRECTORY ${IMPLAM_SOURCE_DIR} OUTPUT_VARIABLE described RESULT_VARIABLE failed
      OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(NOT failed)
      set(IMPLAM_COMMIT ${described})
    endif()
  endif()
  configure_file(${IMPLAM_TEMPLATE} ${IMPLAM_MODULE} @ONLY)
  return()
endif()

set(IMPLAM_PROVENANCE_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

# implam_add_provenance(<layer>): compiles the module build_information into this layer.
function(implam_add_provenance layer)
  set(module ${CMAKE_BINARY_DIR}/generated/${layer}/build_information.f90)
  set(renew ${CMAKE_COMMAND}
    -D IMPLAM_SOURCE_DIR=${CMAKE_SOURCE_DIR}
    -D IMPLAM_TEMPLATE=${CMAKE_SOURCE_DIR}/src/${layer}/build_information.f90.in
    -D IMPLAM_MODULE=${module}
    -D IMPLAM_VERSION=${PROJECT_VERSION}
    -D "IMPLAM_COMPILER=${CMAKE_Fortran_COMPILER_ID} ${CMAKE_Fortran_COMPILER_VERSION}"
    -D IMPLAM_PETSC_VERSION=${PETSC_VERSION}
    -P ${IMPLAM_PROVENANCE_SCRIPT})
  execute_process(COMMAND ${renew} COMMAND_ERROR_IS_FATAL ANY)
  add_custom_target(implam_provenance COMMAND ${renew} BYPRODUCTS ${module} VERBATIM
    COMMENT "Noting version and commit")
  target_sources(implam_${layer} PRIVATE ${module})
  add_dependencies(implam_${layer} implam_provenance)
endfunction()
