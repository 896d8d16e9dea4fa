if(GLOAM_FUZZ)
  add_custom_target(fuzzers)
endif()

# Eight files are compiled as one: their headers are read, and what templates make of them is compiled, once. A third of the time.
# Names in anonymous namespaces are therefore no two files' of a module; what a file uses it includes (lint compiles each alone).
option(GLOAM_UNITY "Compile several files of a module as one" ON)
function(gloam_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${GLOAM_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

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
  if(tests)
    add_executable(${target}_test ${tests})
    gloam_unity(${target}_test)
    target_link_libraries(${target}_test PRIVATE ${target} ${arg_TEST_DEPENDS} GTest::gtest GTest::gmock GTest::gtest_main)
    if(NOT arg_FAST_TESTS)
      target_compile_options(${target}_test PRIVATE ${GLOAM_TEST_OPTIMISE})
    endif()
    target_compile_definitions(${target}_test PRIVATE GLOAM_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
    add_test(NAME ${name} COMMAND ${target}_test)
    set_tests_properties(${name} PROPERTIES LABELS unit TIMEOUT 1200)
  endif()

  if(GLOAM_FUZZ)
    file(GLOB targets CONFIGURE_DEPENDS ${folder}/fuzz/*_fuzz.cc)
    foreach(file IN LISTS targets)
      get_filename_component(fuzz ${file} NAME_WE)
      add_executable(${fuzz} ${file})
      target_link_libraries(${fuzz} PRIVATE ${target})
      target_link_options(${fuzz} PRIVATE -fsanitize=fuzzer)
      add_dependencies(fuzzers ${fuzz})
    endforeach()
  endif()
endfunction()
