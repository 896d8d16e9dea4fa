# cmake --install FOLDER [--prefix PREFIX]: a tree that can be moved and needs neither source nor build folder.
#   bin/gloam                  the program
#   lib/libgloam.so            all modules as one library; include/gloam/ is its interface; find_package(gloam) finds it
#   lib/gloam/                 MuJoCo and its plugins, eiquadprog, Open Image Denoise (where the wheels were there)
#   share/gloam/               what gloam_home() is then: assets, examples
set(CMAKE_INSTALL_LIBDIR lib)  # the same everywhere: the program looks for its own libraries there
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(modules base trajectory ros mcap geometry places scene world instant sim render sensors policy control metrics topics record runtime report web bridge studio teleop)
list(TRANSFORM modules PREPEND gloam_)
add_library(gloam_library SHARED)
foreach(module IN LISTS modules)
  target_sources(gloam_library PRIVATE $<TARGET_OBJECTS:${module}>)
endforeach()
target_link_libraries(gloam_library PRIVATE ${modules})  # for what they link in turn
target_include_directories(gloam_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(gloam_library INTERFACE cxx_std_20)
set_target_properties(gloam_library PROPERTIES OUTPUT_NAME gloam EXPORT_NAME gloam VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN/gloam"
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set_target_properties(gloam PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/gloam")
# The build folder is laid out as what is installed. With a path of its own CMake would end it with an empty part, to
# the loader the current folder: a stranger's library there would be taken.
set_target_properties(gloam gloam_library PROPERTIES BUILD_WITH_INSTALL_RPATH ON)
get_target_property(mujoco_library mujoco::mujoco LOCATION)
get_filename_component(mujoco_folder ${mujoco_library} DIRECTORY)
set(private_build ${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}/gloam)
if(IS_SYMLINK ${private_build})  # of builds that had only MuJoCo there
  file(REMOVE ${private_build})
endif()
file(MAKE_DIRECTORY ${private_build})
get_target_property(eiquadprog_library eiquadprog::eiquadprog LOCATION)
file(GLOB private_files ${mujoco_folder}/*)
foreach(file IN LISTS private_files eiquadprog_library)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${private_build}/${name} SYMBOLIC)
endforeach()

install(TARGETS gloam)
install(TARGETS gloam_library EXPORT gloam)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/include/gloam ${CMAKE_BINARY_DIR}/generated/gloam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/gloam)
install(EXPORT gloam NAMESPACE gloam:: FILE gloamConfig.cmake DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/gloamConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gloamConfigVersion.cmake DESTINATION ${package})

set(private ${CMAKE_INSTALL_LIBDIR}/gloam)
if(DEFINED mujoco_dir)  # from the wheel; a user's own MuJoCo stays where it is
  install(FILES ${mujoco_dir}/libmujoco.so.4.0.1 DESTINATION ${private})
  install(DIRECTORY ${mujoco_dir}/plugin DESTINATION ${private})
endif()
if(DEFINED eiquadprog_dir)
  install(FILES ${eiquadprog_dir}/lib/libeiquadprog.so DESTINATION ${private})
endif()
file(GLOB oidn ${GLOAM_WHEELS}/pyoidn/oidn/lib/libOpenImageDenoise.so.2 ${GLOAM_WHEELS}/pyoidn/oidn/lib/libOpenImageDenoise_core.so.*
  ${GLOAM_WHEELS}/pyoidn/oidn/lib/libOpenImageDenoise_device_cpu.so.* ${GLOAM_WHEELS}/pyoidn/oidn/lib/libtbb.so.12)
install(FILES ${oidn} DESTINATION ${private}/oidn/lib)  # they look for each other in ../lib
install(FILES ${GLOAM_WHEELS}/coacd/lib_coacd.so DESTINATION ${private}/coacd)
file(GLOB coacd_libs ${GLOAM_WHEELS}/coacd.libs/*.so*)
install(FILES ${coacd_libs} DESTINATION ${private}/coacd.libs)  # where it looks for them
install(DIRECTORY ${CMAKE_SOURCE_DIR}/assets ${CMAKE_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/gloam
  PATTERN __pycache__ EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
