if(GLOAM_FUZZ)
  add_custom_target(fuzzers)
endif()

# Eight files are compiled as one: their headers are read, and what templates make of them is compiled, once. A third of the time.
# Names in anonymous namespaces are therefore no two files' of a module; what a file uses it includes (lint compiles each alone).
option(GLOAM_UNITY "Compile several files of a module as one" ON)
function(gloam_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${GLOAM_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# The only object that depends on where the source is, so a compiler cache serves all clones.
configure_file(${CMAKE_SOURCE_DIR}/src/base/test/source_dir.cc.in ${CMAKE_BINARY_DIR}/generated/source_dir.cc @ONLY)
add_library(gloam_source_dir STATIC EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/generated/source_dir.cc)
target_include_directories(gloam_source_dir PRIVATE ${CMAKE_SOURCE_DIR}/src)

# gloam_module(NAME [FAST_TESTS] [COLD] [DEPENDS targets…] [TEST_DEPENDS targets…] [EXCLUDE files…])
# One folder of src/ = one static library gloam_NAME of all its .cc files (test/ and fuzz/ apart),
# one test program gloam_NAME_test of test/*_test.cc (FAST_TESTS: its tests do the work themselves, in code that headers
# bring, so they are optimised like the library; the others are compiled in less time), one fuzz program per fuzz/*_fuzz.cc.
# COLD: little of its time is its own code: it is optimised as far as that takes little of ours, and not at all in sanitized
# builds.
function(gloam_module name)
  cmake_parse_arguments(arg "FAST_TESTS;COLD" "" "DEPENDS;TEST_DEPENDS;EXCLUDE" ${ARGN})
  set(folder ${CMAKE_SOURCE_DIR}/src/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cc)
  list(FILTER sources EXCLUDE REGEX "/(test|fuzz)/")
  foreach(file IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM sources ${folder}/${file})
  endforeach()
  set(target gloam_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    gloam_unity(${target})
    if(arg_COLD)
      target_compile_options(${target} PRIVATE ${GLOAM_COLD_OPTIMISE})
    endif()
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)  # headers only
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR}/include)
  target_link_libraries(${target} ${scope} ${arg_DEPENDS} Threads::Threads ${CMAKE_DL_LIBS})

  file(GLOB tests CONFIGURE_DEPENDS ${folder}/test/*.cc)
  foreach(file IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM tests ${folder}/${file})
  endforeach()
  if(tests)
    add_executable(${target}_test ${tests})
    gloam_unity(${target}_test)
    target_link_libraries(${target}_test PRIVATE ${target} ${arg_TEST_DEPENDS} gloam_source_dir GTest::gtest GTest::gmock GTest::gtest_main)
    if(NOT arg_FAST_TESTS)
      target_compile_options(${target}_test PRIVATE ${GLOAM_TEST_OPTIMISE})
    endif()
    gloam_unit_tests(${name} ${target}_test)
  endif()

  if(GLOAM_FUZZ)
    file(GLOB targets CONFIGURE_DEPENDS ${folder}/fuzz/*_fuzz.cc)
    foreach(file IN LISTS arg_EXCLUDE)
      list(REMOVE_ITEM targets ${folder}/${file})
    endforeach()
    foreach(file IN LISTS targets)
      get_filename_component(fuzz ${file} NAME_WE)
      add_executable(${fuzz} ${file})
      target_link_libraries(${fuzz} PRIVATE ${target})
      target_link_options(${fuzz} PRIVATE -fsanitize=fuzzer)
      add_dependencies(fuzzers ${fuzz})
      gloam_fuzz_test(${fuzz})
    endforeach()
  endif()
endfunction()
