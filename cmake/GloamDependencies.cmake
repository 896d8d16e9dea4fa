# Everything Gloam links: Debian packages, and MuJoCo from the wheel that ./gloam unpacks into .venv/wheels.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(TBB REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Eigen3 QUIET NO_MODULE)
find_package(tomlplusplus QUIET)
find_package(pugixml QUIET)
# Embree 4, else 3: src/render/cpu/tracer/embree_api.h has what differs.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 QUIET)
endif()
find_package(ZLIB REQUIRED)
find_package(PNG QUIET)
find_package(JPEG QUIET)
find_package(OpenEXR QUIET)
find_package(GTest REQUIRED)
find_package(benchmark QUIET)

pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
add_library(gloam_xxhash ALIAS PkgConfig::XXHASH)
pkg_check_modules(RE2 REQUIRED IMPORTED_TARGET re2)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(OPENH264 IMPORTED_TARGET openh264)

# Bridges: what is missing is told of when such a bridge is asked for.
# Fast DDS 3, else 2, whose CMake package has the older name: src/bridge/ros2/dds_api.h has what differs.
find_package(fastdds 3 QUIET)
if(fastdds_FOUND)
  set(GLOAM_FAST_DDS fastdds fastcdr)
else()
  find_package(fastrtps QUIET)
  if(fastrtps_FOUND)
    set(GLOAM_FAST_DDS fastrtps fastcdr)
  endif()
endif()
pkg_check_modules(ZMQ IMPORTED_TARGET libzmq)
# Users of zmq.h need no folders or options of what libzmq itself is made with. CMake would give them in one form when it
# configures first and in another from its cache, and each change compiles the programs anew.
if(TARGET PkgConfig::ZMQ)
  set_target_properties(PkgConfig::ZMQ PROPERTIES INTERFACE_COMPILE_OPTIONS "" INTERFACE_INCLUDE_DIRECTORIES "")
endif()
find_path(CPPZMQ_INCLUDE zmq.hpp)
find_path(MSGPACK_INCLUDE msgpack.hpp)

# Recast and Detour, where agents can go: Debian's package has neither CMake nor pkg-config files. Without them a stub says so.
find_path(RECAST_INCLUDE recastnavigation/Recast.h)
foreach(part Recast Detour DetourCrowd)
  find_library(RECAST_${part} ${part})
endforeach()
if(RECAST_INCLUDE AND RECAST_Recast AND RECAST_Detour AND RECAST_DetourCrowd)
  add_library(gloam_recast INTERFACE)
  target_include_directories(gloam_recast SYSTEM INTERFACE ${RECAST_INCLUDE})
  target_link_libraries(gloam_recast INTERFACE ${RECAST_DetourCrowd} ${RECAST_Detour} ${RECAST_Recast})
endif()

# MuJoCo: a user's own package is honoured; otherwise the pinned wheel holds the library, all headers and the manual.
set(GLOAM_WHEELS ${CMAKE_SOURCE_DIR}/.venv/wheels CACHE PATH "Folder of the unpacked Python wheels")
find_package(mujoco 4.0.1 QUIET)
if(NOT TARGET mujoco::mujoco)
  set(mujoco_dir ${GLOAM_WHEELS}/mujoco)
  if(NOT EXISTS ${mujoco_dir}/libmujoco.so.4.0.1)
    message(FATAL_ERROR "MuJoCo 4.0.1 is missing in ${mujoco_dir}: run ./gloam setup")
  endif()
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(mujoco::mujoco PROPERTIES
    IMPORTED_LOCATION ${mujoco_dir}/libmujoco.so.4.0.1
    IMPORTED_SONAME libmujoco.so.4.0.1
    INTERFACE_INCLUDE_DIRECTORIES ${mujoco_dir}/include)
  set(GLOAM_MUJOCO_DOC ${mujoco_dir}/doc CACHE PATH "MuJoCo's manual, as its wheel has it: texts and units of the schema")
endif()

# Quadratic programs of inverse kinematics, LGPL and therefore always linked as a shared library: a user's own package is
# honoured, otherwise the pinned wheel has the library and its headers.
find_package(eiquadprog 1.3 QUIET)
if(NOT TARGET eiquadprog::eiquadprog)
  set(eiquadprog_dir ${GLOAM_WHEELS}/cmeel.prefix)
  if(NOT EXISTS ${eiquadprog_dir}/lib/libeiquadprog.so)
    message(FATAL_ERROR "eiquadprog is missing in ${eiquadprog_dir}: run ./gloam setup")
  endif()
  add_library(eiquadprog::eiquadprog SHARED IMPORTED)
  set_target_properties(eiquadprog::eiquadprog PROPERTIES
    IMPORTED_LOCATION ${eiquadprog_dir}/lib/libeiquadprog.so
    IMPORTED_SONAME libeiquadprog.so
    INTERFACE_INCLUDE_DIRECTORIES ${eiquadprog_dir}/include)
endif()
