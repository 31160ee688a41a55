# Compiler flags, one line of reason each. Presets choose the build type.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, Sanitize or Coverage" FORCE)
endif()
option(IMPLAM_NATIVE "Tune for the processor that builds (switch off for a binary that travels)" ON)

if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
  set(IMPLAM_FLAGS
    -std=f2008            # the language of the project, no extensions
    -fimplicit-none
    -Wall -Wextra
    -Wno-maybe-uninitialized -Wno-uninitialized # gfortran 12 reports descriptors of allocatables that are fine
    -Wno-unused-dummy-argument # an override need not use every argument of its interface
    -Wno-compare-reals)        # exact comparisons are written where they are meant
  set(IMPLAM_RELEASE -O3 -funroll-loops
    -fno-math-errno       # square roots without a call; NaN and Inf keep their meaning
    -ffp-contract=off)    # the same digits wherever the compiler puts a copy of a procedure: restarts need them
  if(IMPLAM_NATIVE)
    list(APPEND IMPLAM_RELEASE -march=native)
  endif()
  set(IMPLAM_RELEASE_TEST -O0) # after the others: tests compute little themselves, and compile four times as fast
  set(IMPLAM_RELEASE_C -ffp-contract=off)
  if(IMPLAM_NATIVE AND CMAKE_C_COMPILER_ID STREQUAL "GNU")
    list(APPEND IMPLAM_RELEASE_C -march=native)
  endif()
  set(IMPLAM_DEBUG -Og -g -fbacktrace
    -fcheck=all,no-array-temps             # bounds, shapes, allocation, pointers
    -ffpe-trap=invalid,zero,overflow       # stop where the first NaN is born
    -finit-real=snan -finit-integer=-99999 # a variable read before it is set is caught
    -finit-derived)
  # Not all of "undefined": absent optional arguments and empty arrays are null pointers, which gfortran means.
  set(IMPLAM_SANITIZERS address,alignment,bool,float-cast-overflow,integer-divide-by-zero,shift,signed-integer-overflow)
  set(IMPLAM_SANITIZE -O1 -g -fbacktrace -fno-omit-frame-pointer -ffp-contract=off
    -fsanitize=${IMPLAM_SANITIZERS} -fno-sanitize-recover=all)
  set(IMPLAM_COVERAGE -O0 -g --coverage)
else()
  set(IMPLAM_FLAGS)
  set(IMPLAM_RELEASE -O3)
  set(IMPLAM_RELEASE_TEST -O0)
  set(IMPLAM_DEBUG -g)
  set(IMPLAM_SANITIZERS address)
  set(IMPLAM_SANITIZE -g)
  set(IMPLAM_COVERAGE -g)
endif()

# Targets of tests: those created where the variable IMPLAM_TEST is true.
define_property(TARGET PROPERTY IMPLAM_TEST INITIALIZE_FROM_VARIABLE IMPLAM_TEST)

# The flags go with the targets of Implam, not with the tests' framework or CMake's probes.
add_library(implam_flags INTERFACE)
target_compile_options(implam_flags INTERFACE
  $<$<COMPILE_LANGUAGE:Fortran>:${IMPLAM_FLAGS}>
  $<$<AND:$<COMPILE_LANGUAGE:Fortran>,$<CONFIG:Release>>:${IMPLAM_RELEASE}>
  $<$<AND:$<COMPILE_LANGUAGE:Fortran>,$<CONFIG:Release>,$<BOOL:$<TARGET_PROPERTY:IMPLAM_TEST>>>:${IMPLAM_RELEASE_TEST}>
  $<$<AND:$<COMPILE_LANGUAGE:C>,$<CONFIG:Release>>:${IMPLAM_RELEASE_C}>
  $<$<AND:$<COMPILE_LANGUAGE:Fortran>,$<CONFIG:Debug>>:${IMPLAM_DEBUG}>
  "$<$<CONFIG:Sanitize>:${IMPLAM_SANITIZE}>"
  $<$<AND:$<COMPILE_LANGUAGE:Fortran>,$<CONFIG:Coverage>>:${IMPLAM_COVERAGE}>)
target_link_options(implam_flags INTERFACE $<$<CONFIG:Coverage>:--coverage>
  "$<$<CONFIG:Sanitize>:-fsanitize=${IMPLAM_SANITIZERS}>")
set(CMAKE_Fortran_FLAGS_RELEASE "")
set(CMAKE_Fortran_FLAGS_DEBUG "")
