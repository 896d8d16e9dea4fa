# Unit tests for ctest: one test per module and label. A process for each test of Google Test would take 1.7 times as long (scene).
# `MODULE` (label unit) runs all tests of a module, or those of GTEST_FILTER; `MODULE.fast` runs the tests without a label in
# tests/labels.txt. The module's reports, in JUnit's XML, are in reports/ of the build folder.
set(gloam_labels ${CMAKE_SOURCE_DIR}/tests/labels.txt)
set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${gloam_labels})
# Longest first; ctest knows the times of later runs.
set(gloam_longest render.fast world.slow runtime.fast sim.fast runtime.slow sensors.fast world.fast sim.slow studio.fast bridge.fast)
set(gloam_main_fuzzers scene_toml_fuzz robot_entry_fuzz model_path_fuzz model_xml_fuzz)  # fuzzed in CI
add_custom_target(unit_tests)
add_custom_target(cuda_tests)
add_custom_target(main_fuzzers)

# gloam_test(NAME LABEL PROGRAM [ARGUMENT…])
function(gloam_test name label program)
  add_test(NAME ${name} COMMAND ${program} --gtest_brief=1 ${ARGN})
  list(FIND gloam_longest ${name} rank)
  if(rank LESS 0)
    set(rank 99)
  endif()
  math(EXPR cost "100 - ${rank}")
  set_tests_properties(${name} PROPERTIES LABELS ${label} COST ${cost} TIMEOUT 3600
    ENVIRONMENT "GTEST_OUTPUT=xml:${CMAKE_BINARY_DIR}/reports/${name}.xml")
endfunction()

# gloam_labelled(MODULE LABEL VARIABLE): the patterns of the module's tests with this label, joined by colons.
function(gloam_labelled module label variable)
  file(STRINGS ${gloam_labels} lines REGEX "^${module} +${label} ")
  list(TRANSFORM lines REPLACE "^[a-z]+ +[a-z]+ +" "")
  list(JOIN lines ":" patterns)
  set(${variable} "${patterns}" PARENT_SCOPE)
endfunction()

# gloam_unit_tests(MODULE PROGRAM): the tests of a module's program.
function(gloam_unit_tests module program)
  add_dependencies(unit_tests ${program})
  foreach(label IN ITEMS slow full sweeps mutations)
    gloam_labelled(${module} ${label} ${label})
  endforeach()
  gloam_test(${module} unit ${program})
  list(APPEND others ${slow} ${full})
  list(JOIN others ":" others)
  gloam_test(${module}.fast fast ${program} --gtest_filter=-${others})
  if(slow)
    gloam_test(${module}.slow slow ${program} --gtest_filter=${slow}-${full})
  endif()
  if(full)
    gloam_test(${module}.full full ${program} --gtest_filter=${full})
  endif()
  if(sweeps)
    gloam_test(${module}.sweeps sweeps ${program} --gtest_filter=${sweeps} --gtest_also_run_disabled_tests)
  endif()
  if(mutations)  # damaged files; without GLOAM_MUTATIONS, each reader takes 200
    gloam_test(${module}.mutations mutations ${program} --gtest_filter=${mutations})
    set_property(TEST ${module}.mutations APPEND PROPERTY ENVIRONMENT GLOAM_MUTATIONS=10000)
  endif()
endfunction()

# gloam_fuzz_test(PROGRAM): five minutes of a fuzzer, and 15 s of the main ones. The corpus grows in corpus/.
function(gloam_fuzz_test program)
  set(folders ${CMAKE_BINARY_DIR}/corpus/${program}/)
  file(MAKE_DIRECTORY ${folders})
  set(options -timeout=5 -rss_limit_mb=1024 -artifact_prefix=${folders})
  if(EXISTS ${CMAKE_SOURCE_DIR}/tests/fuzz/${program})
    list(APPEND folders ${CMAKE_SOURCE_DIR}/tests/fuzz/${program})
  endif()
  list(APPEND options ${folders})
  add_test(NAME fuzz.${program} COMMAND ${program} -max_total_time=300 ${options})
  set_tests_properties(fuzz.${program} PROPERTIES LABELS fuzz TIMEOUT 900)
  if(program IN_LIST gloam_main_fuzzers)
    add_dependencies(main_fuzzers ${program})
    add_test(NAME fuzz_main.${program} COMMAND ${program} -max_total_time=15 ${options})
    set_tests_properties(fuzz_main.${program} PROPERTIES LABELS fuzz_main TIMEOUT 300)
  endif()
endfunction()
