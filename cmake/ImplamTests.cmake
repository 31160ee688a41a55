# How the tests of Implam are registered.

# The same processors, threads and launcher settings for every test, so that two tests at a time do not
# disturb each other: one thread a rank, ranks not bound to cores, more ranks than cores allowed. Open MPI 4 and 5 have
# names of their own for the last two.
set(IMPLAM_TEST_ENVIRONMENT OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
  OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
  PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe PRTE_MCA_hwloc_default_binding_policy=none)
execute_process(COMMAND id -u OUTPUT_VARIABLE user OUTPUT_STRIP_TRAILING_WHITESPACE)
if(user EQUAL 0) # Open MPI refuses to start for root unless asked twice
  list(APPEND IMPLAM_TEST_ENVIRONMENT OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1)
endif()

if(CMAKE_BUILD_TYPE STREQUAL "Sanitize") # MPI and HDF5 keep memory to the end on purpose
  list(APPEND IMPLAM_TEST_ENVIRONMENT ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1)
endif()

# implam_settle_test(<test> <label>): label, environment and time limit of a registered test.
function(implam_settle_test test label)
  set_tests_properties(${test} PROPERTIES LABELS ${label} ENVIRONMENT "${IMPLAM_TEST_ENVIRONMENT}" TIMEOUT 600)
endfunction()

# implam_on_demand(<test>...): longer tests beside quicker ones of the same kind. They have the label slow, which the
# presets leave out: `ctest --test-dir build -L slow` runs them.
function(implam_on_demand)
  set_property(TEST ${ARGN} APPEND PROPERTY LABELS slow)
endfunction()

# implam_share_cores(<test>...): tests of several ranks; one that waits for another leaves its core to others.
function(implam_share_cores)
  set_property(TEST ${ARGN} APPEND PROPERTY ENVIRONMENT OMPI_MCA_mpi_yield_when_idle=1)
endfunction()

# implam_add_unit_tests(<layer>...): one test program a layer from tests/unit/<layer>/*.pf and the helpers
# beside them (*.f90); it sees this layer and those left of it. From linalg on, PETSc is started first. The target
# unit_tests builds all of them.
function(implam_add_unit_tests)
  add_custom_target(unit_tests)
  set(lower "")
  foreach(layer IN LISTS ARGN)
    list(APPEND lower ${layer})
    # Relative names: pFUnit writes the Fortran of an absolute one beside it, into the source.
    set(here ${CMAKE_CURRENT_SOURCE_DIR})
    file(GLOB tests RELATIVE ${here} CONFIGURE_DEPENDS ${here}/unit/${layer}/*.pf)
    file(GLOB helpers RELATIVE ${here} CONFIGURE_DEPENDS ${here}/unit/${layer}/*.f90)
    if(NOT tests OR NOT TARGET implam_${layer})
      continue()
    endif()
    set(arguments "")
    implam_needs_processes(processes ${tests})
    if(processes)
      list(APPEND arguments MAX_PES 4)
    endif()
    if("linalg" IN_LIST lower)
      list(APPEND helpers support/rows_of_elements.f90 support/petsc_fixture.f90)
      list(APPEND arguments EXTRA_USE petsc_fixture EXTRA_INITIALIZE start_petsc_for_tests)
    endif()
    if("deck" IN_LIST lower)
      list(APPEND helpers support/deck_groups.f90)
    endif()
    if("results" IN_LIST lower)
      list(APPEND helpers support/sample_builds.f90)
    endif()
    if("model" IN_LIST lower)
      list(APPEND helpers support/small_setups.f90 support/laminated_plates.f90)
    endif()
    if("interfaces" IN_LIST lower)
      list(APPEND helpers support/layered_plates.f90)
    endif()
    if("newton" IN_LIST lower)
      list(APPEND helpers support/small_operators.f90)
    endif()
    add_library(tested_${layer} INTERFACE)
    implam_link_layers(tested_${layer} ${lower})
    add_pfunit_ctest(unit_${layer} TEST_SOURCES ${tests} OTHER_SOURCES ${helpers}
                     LINK_LIBRARIES tested_${layer} ${arguments})
    add_dependencies(unit_tests unit_${layer})
    implam_follow_layers(unit_${layer} ${lower})
    implam_settle_test(unit_${layer} unit)
    if(processes) # on two cores one such program at a time
      set_tests_properties(unit_${layer} PROPERTIES PROCESSORS 2)
      implam_share_cores(unit_${layer})
    endif()
  endforeach()
endfunction()

# implam_follow_layers(<target> <layer>...): compiles the target's sources again when modules of the layers
# change, which CMake follows within a target only. A source of several targets keeps the first one's layers.
function(implam_follow_layers target)
  list(TRANSFORM ARGN PREPEND ${CMAKE_BINARY_DIR}/ OUTPUT_VARIABLE stamps)
  list(TRANSFORM stamps APPEND .stamp)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(known ${source} OBJECT_DEPENDS)
    if(NOT known)
      set_property(SOURCE ${source} PROPERTY OBJECT_DEPENDS ${stamps})
    endif()
  endforeach()
endfunction()

# implam_needs_processes(<variable> <test file>...): does any of the files test on several processes?
function(implam_needs_processes variable)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  set(found "")
  foreach(name IN LISTS ARGN)
    file(STRINGS ${name} uses REGEX "^ *use +pfunit" LIMIT_COUNT 1)
    list(APPEND found ${uses})
  endforeach()
  set(${variable} ${found} PARENT_SCOPE)
endfunction()

# implam_test_stand_in(): shows that the stand-in for pFUnit counts failures and ends with a code.
function(implam_test_stand_in)
  add_pfunit_ctest(framework_counts TEST_SOURCES framework/failing.pf MAX_PES 2)
  implam_settle_test(framework_counts unit)
  implam_share_cores(framework_counts)
  set_tests_properties(framework_counts PROPERTIES PASS_REGULAR_EXPRESSION "9 tests run, 9 failed")
  add_test(NAME framework_fails COMMAND framework_counts -f test_condition)
  add_test(NAME framework_needs_a_test COMMAND framework_counts -f none_of_this_name)
  foreach(test framework_fails framework_needs_a_test)
    implam_settle_test(${test} unit)
    set_tests_properties(${test} PROPERTIES WILL_FAIL TRUE)
  endforeach()
endfunction()
