# CUDA without CMake's own support for it: nvcc comes from a toolkit, or from the PyPI wheels that ./gloam unpacks into
# .venv/cuda, whose layout CMake does not know. The runtime is linked statically and looks for the driver when it is first
# called, so the program starts where there is none.
option(GLOAM_CUDA "Compile the stages for NVIDIA cards" OFF)
set(GLOAM_CUDA_ARCH 90 CACHE STRING "Compute capability of the card, without its point; later ones compile its PTX")

set(cuda_wheels ${CMAKE_SOURCE_DIR}/.venv/cuda/nvidia/cu13)
find_program(GLOAM_NVCC nvcc HINTS ENV CUDA_PATH PATHS /usr/local/cuda ${cuda_wheels} PATH_SUFFIXES bin)
if(NOT GLOAM_NVCC)
  if(NOT GLOAM_CUDA)
    return()
  endif()
  message(FATAL_ERROR "nvcc is missing: install a CUDA 13 toolkit, or run GLOAM_PRESET=cuda ./gloam setup")
endif()
get_filename_component(cuda_root ${GLOAM_NVCC} REALPATH)
get_filename_component(cuda_root ${cuda_root} DIRECTORY)
get_filename_component(cuda_root ${cuda_root} DIRECTORY)
set(required)
if(GLOAM_CUDA)
  set(required REQUIRED)
endif()
find_library(GLOAM_CUDART cudart_static HINTS ${cuda_root} PATH_SUFFIXES lib lib64 NO_DEFAULT_PATH ${required})
find_path(GLOAM_CUDA_INCLUDE cuda_runtime_api.h HINTS ${cuda_root} PATH_SUFFIXES include NO_DEFAULT_PATH ${required})
if(NOT GLOAM_CUDART OR NOT GLOAM_CUDA_INCLUDE)
  return()  # half a toolkit, of which this build asks nothing
endif()
set(GLOAM_CAN_COMPILE_CUDA ON)
message(STATUS "nvcc: ${GLOAM_NVCC}")

# gloam_cuda_sources(TARGET FILE.cu…): compiles the files for the card and makes them part of the target.
function(gloam_cuda_sources target)
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME_WE)
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    set(object ${CMAKE_CURRENT_BINARY_DIR}/${name}.cu.o)
    set(flags -DGLOAM_INLINE=inline)
    set(code compute_${GLOAM_CUDA_ARCH})
    # The plain kernels are small: what they leave out must fold away in all that they call. A call at the vertices of paths
    # would put their state into memory.
    if(name MATCHES "^(plain|wave_scatter)")
      set(flags -DGLOAM_INLINE=__forceinline__)
    endif()
    # Where only a test asks for them, the card's driver is left to make machine code of the large kernels: minutes less.
    if(name MATCHES "^(plain|gas)" OR GLOAM_CUDA)
      set(code sm_${GLOAM_CUDA_ARCH},${code})
    endif()
    if(name MATCHES "^gas")  # a gas has the CPU's bits, so nothing is contracted; its loops are lambdas
      list(APPEND flags -fmad=false --extended-lambda)
    endif()
    if(name MATCHES "path$")  # light is judged by its mean; what must be exact is in other files
      list(APPEND flags -use_fast_math)
    endif()
    add_custom_command(OUTPUT ${object}
      COMMAND ${GLOAM_NVCC} -std=c++20 -O3 --expt-relaxed-constexpr -ccbin ${CMAKE_CXX_COMPILER} -Xcompiler -fPIC
        -gencode arch=compute_${GLOAM_CUDA_ARCH},code=[${code}]
        ${flags} -I${CMAKE_SOURCE_DIR}/src -I${CMAKE_SOURCE_DIR}/include
        -MD -MF ${object}.d -c ${source} -o ${object}
      MAIN_DEPENDENCY ${source} DEPFILE ${object}.d COMMENT "Compiling ${file} for the card" VERBATIM)
    target_sources(${target} PRIVATE ${object})
  endforeach()
  target_link_libraries(${target} PRIVATE ${GLOAM_CUDART} rt)
endfunction()
