# One OBJECT library a folder, each with its own module directory.

# implam_add_layers(<layer>... [/ <layer>...]...): layers in order. A slash begins a new tier: a layer sees the
# modules of the tiers before its own and none of its neighbours.
function(implam_add_layers)
  set(lower "")
  set(stamps "")
  set(tier "")
  set(tier_stamps "")
  foreach(layer IN LISTS ARGN)
    if(layer STREQUAL "/")
      list(APPEND lower ${tier})
      list(APPEND stamps ${tier_stamps})
      set(tier "")
      set(tier_stamps "")
      continue()
    endif()
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/${layer}/*.f90
                                        ${CMAKE_CURRENT_SOURCE_DIR}/src/${layer}/*.c
                                        ${CMAKE_CURRENT_SOURCE_DIR}/src/${layer}/*.F90)
    add_library(implam_${layer} OBJECT ${sources})
    set_target_properties(implam_${layer} PROPERTIES
      Fortran_MODULE_DIRECTORY ${CMAKE_BINARY_DIR}/modules/${layer})
    implam_remove_old_modules(${layer} ${sources})
    foreach(name IN LISTS lower)
      target_include_directories(implam_${layer} PRIVATE ${CMAKE_BINARY_DIR}/modules/${name})
      add_dependencies(implam_${layer} implam_${name})
    endforeach()
    target_link_libraries(implam_${layer} PRIVATE implam_flags)
    # CMake follows modules within a target only: a stamp with the digest of the layer's modules renews the layers after
    # it. A change that leaves all modules as they are, in the body of a procedure, leaves the stamp and those layers.
    set_property(SOURCE ${sources} APPEND PROPERTY OBJECT_DEPENDS ${stamps})
    add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/${layer}.stamp DEPENDS $<TARGET_OBJECTS:implam_${layer}>
      COMMAND ${CMAKE_COMMAND} -DMODULES=${CMAKE_BINARY_DIR}/modules/${layer} -DSTAMP=${CMAKE_BINARY_DIR}/${layer}.stamp
              -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/module_stamp.cmake VERBATIM)
    list(APPEND tier ${layer})
    list(APPEND tier_stamps ${CMAKE_BINARY_DIR}/${layer}.stamp)
  endforeach()
  # It hands on optional arrays, whose extents gfortran 12 subtracts from each other even where they are absent.
  set_property(SOURCE src/model/models.f90 APPEND PROPERTY COMPILE_OPTIONS
    $<$<CONFIG:Sanitize>:-fno-sanitize=signed-integer-overflow>)
  # Arrays of the size of one node's stack, in the loop over nodes: GNU allocates and frees them in each call otherwise.
  # Larger arrays would exceed the limit of the stack.
  if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
    foreach(module IN ITEMS stack_batches stack_motions stack_solutions stack_updates)
      set_property(SOURCE src/explicit/${module}.f90 APPEND PROPERTY COMPILE_OPTIONS -fstack-arrays)
    endforeach()
  endif()
  implam_give_library(parallel MPI::MPI_Fortran)
  implam_give_library(linalg PkgConfig::PETSC MPI::MPI_Fortran)
  implam_give_library(results hdf5::hdf5_fortran MPI::MPI_Fortran)
  target_include_directories(implam_results PRIVATE ${HDF5_Fortran_INCLUDE_DIRS})
endfunction()

# implam_remove_old_modules(<layer> <source>...): removes modules in the build whose source has left the layer. The
# compiler would find them before those of the layer that has the source.
function(implam_remove_old_modules layer)
  file(GLOB modules ${CMAKE_BINARY_DIR}/modules/${layer}/*.mod)
  foreach(module IN LISTS modules)
    get_filename_component(name ${module} NAME_WE)
    if(NOT name STREQUAL "build_information" AND NOT "${ARGN}" MATCHES "/${name}[.][fF]90")
      message(STATUS "Removing ${module}, whose source has left src/${layer}")
      file(REMOVE ${module})
    endif()
  endforeach()
endfunction()

# implam_give_library(<layer> <library>...): the only layer that may use a library sees it.
function(implam_give_library layer)
  target_link_libraries(implam_${layer} PRIVATE ${ARGN})
endfunction()

# implam_link_layers(<target> <layer>...): links the objects of these layers and their libraries; an
# interface library hands them on.
function(implam_link_layers target)
  get_target_property(type ${target} TYPE)
  set(scope PRIVATE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    set(scope INTERFACE)
  endif()
  foreach(layer IN LISTS ARGN)
    if(TARGET implam_${layer})
      target_sources(${target} ${scope} $<TARGET_OBJECTS:implam_${layer}>)
      target_include_directories(${target} ${scope} ${CMAKE_BINARY_DIR}/modules/${layer})
    endif()
  endforeach()
  if("linalg" IN_LIST ARGN)
    target_link_libraries(${target} ${scope} PkgConfig::PETSC ${OpenMP_Fortran_LIBRARIES})
  endif()
  target_link_libraries(${target} ${scope} implam_flags MPI::MPI_Fortran ${HDF5_Fortran_LIBRARIES} ${METIS_LIBRARY}
    LAPACK::LAPACK)
endfunction()
