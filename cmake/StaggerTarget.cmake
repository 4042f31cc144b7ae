# What all of our own targets have in common. Everything here is private to them, so that a program that links the installed
# engine inherits none of it.

option(STAGGER_NATIVE "Use every instruction of this machine; the binary may not run on another" OFF)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Kind of build" FORCE)
endif()
if(NOT DEFINED CMAKE_COMPILE_WARNING_AS_ERROR)
  set(CMAKE_COMPILE_WARNING_AS_ERROR ON)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

find_program(STAGGER_CCACHE ccache)
if(STAGGER_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths relative to the checkout let one clone reuse what another has compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1 "${STAGGER_CCACHE}")
endif()

# Finds the sources below `folder` (relative to this one) and leaves them in `out`.
function(stagger_sources out folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS
    "${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.h")
  set(${out} ${sources} PARENT_SCOPE)
endfunction()

# In a unit of many sources, a local variable may have the name of another source's constant, and a class that one source
# keeps for itself looks as if a header had it.
set(STAGGER_UNIT_WARNINGS -Wshadow)
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(STAGGER_UNIT_WARNINGS -Wshadow=local -Wno-subobject-linkage)
endif()

function(stagger_configure target)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF LINKER_LANGUAGE CXX)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic ${STAGGER_UNIT_WARNINGS} -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wdouble-promotion
    # A trial must repeat to the bit: no fusing of a multiplication and an addition where the optimiser sees fit.
    -ffp-contract=off)
  if(STAGGER_NATIVE)
    # GCC 12 takes its own AVX-512 intrinsics for reads of what was never written.
    target_compile_options(${target} PRIVATE -march=native
      "$<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized;-Wno-maybe-uninitialized>")
  endif()
endfunction()
