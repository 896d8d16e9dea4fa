# Compiler settings for every target. Floating point is strict: results must not depend on the optimiser's mood.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(GLOAM_CCACHE ccache)
if(GLOAM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${GLOAM_CCACHE})
endif()
find_program(GLOAM_MOLD mold)
if(GLOAM_MOLD AND NOT GLOAM_SANITIZE)
  add_link_options(-fuse-ld=mold)
endif()

add_compile_options(-Wall -Wextra -Werror -Wno-missing-field-initializers -ffp-contract=off -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports std::string members of values returned through std::variant as uninitialised (GCC bug 105562 and kin).
  add_compile_options(-Wno-maybe-uninitialized -Wno-restrict)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wno-bitwise-instead-of-logical)  # generic over bool and lanes: render/kernel/lanes.h
endif()
add_compile_options("$<$<CONFIG:Release>:-O3>")
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  add_compile_options(-march=${GLOAM_MARCH})
endif()
if(GLOAM_DCHECKS)
  add_compile_definitions(GLOAM_DCHECKS=1)
endif()
if(GLOAM_SANITIZE)
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")  # half the build time of -O2, and readable stacks
  add_compile_options(-fsanitize=${GLOAM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${GLOAM_SANITIZE})
endif()
if(GLOAM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Programs side by side in one folder, whatever folder of the source they come from.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
