# Compiler settings for every target. Floating point is strict: results must not depend on the optimiser's mood.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Objects of one clone serve another: paths below the source folder are relative in commands and in __FILE__.
find_program(GLOAM_CCACHE ccache)
if(GLOAM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${GLOAM_CCACHE})
endif()
find_program(GLOAM_MOLD mold)
if(GLOAM_MOLD AND NOT GLOAM_SANITIZE)
  add_link_options(-fuse-ld=mold)
endif()

option(GLOAM_WERROR "Treat warnings as errors, as CI does; a compiler that CI does not use may warn of other things" OFF)
set(werror)
if(GLOAM_WERROR)
  set(werror -Werror)
endif()
add_compile_options(-Wall -Wextra ${werror} -Wno-missing-field-initializers -ffp-contract=off -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports std::string members of values returned through std::variant as uninitialised (GCC bug 105562 and kin).
  add_compile_options(-Wno-maybe-uninitialized -Wno-restrict)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # The kernel is generic over bool and lanes (render/kernel/math/lanes.h); GCC 12's std::stable_sort calls what C++17 deprecates.
  add_compile_options(-Wno-bitwise-instead-of-logical -Wno-deprecated-declarations)
endif()
add_compile_options(-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
add_compile_options("$<$<CONFIG:Release>:-O3>")
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  # Results are the same on every level; rays are traced in sixteens with AVX-512, else in eights.
  set(march ${GLOAM_MARCH})
  if(NOT march)
    include(CheckCXXSourceRuns)
    check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx512f\") && __builtin_cpu_supports(\"avx512bw\") &&
      __builtin_cpu_supports(\"avx512cd\") && __builtin_cpu_supports(\"avx512dq\") && __builtin_cpu_supports(\"avx512vl\") ? 0 : 1; }"
      GLOAM_RUNS_AVX512)
    check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }" GLOAM_RUNS_AVX2)
    set(march x86-64-v2)
    if(GLOAM_RUNS_AVX512)
      set(march x86-64-v4)
    elseif(GLOAM_RUNS_AVX2)
      set(march x86-64-v3)
    endif()
  endif()
  message(STATUS "-march=${march}")
  add_compile_options(-march=${march})
endif()
if(GLOAM_DCHECKS)
  add_compile_definitions(GLOAM_DCHECKS=1)
endif()
set(GLOAM_COLD_OPTIMISE -O1)  # of modules in which little time is spent
set(GLOAM_TEST_OPTIMISE -O1)  # for tests that leave the work to the library: two thirds of the time that -O3 takes
if(GLOAM_SANITIZE)
  set(GLOAM_COLD_OPTIMISE -O0)
  set(GLOAM_TEST_OPTIMISE -O0)
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")  # half the build time of -O2, and readable stacks
  add_compile_definitions(GLOAM_SANITIZED=1)  # malloc is the sanitizer's, and times say nothing
  add_compile_options(-fsanitize=${GLOAM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${GLOAM_SANITIZE})
endif()
if(GLOAM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Programs side by side in one folder, whatever folder of the source they come from.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
