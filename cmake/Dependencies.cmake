# What is built upon: Debian's and Ubuntu's packages, installed by scripts/setup.
find_package(Threads REQUIRED)
if(ODIS_TBB OR ODIS_RENDERER)
  find_package(TBB REQUIRED)
endif()
# Optional, for maps at pixels by a network.
option(ODIS_ONEDNN "Build the network at pixels, where oneDNN is found" ${PROJECT_IS_TOP_LEVEL})
if(ODIS_ONEDNN)
  find_path(DNNL_INCLUDE_DIR dnnl.hpp)
  find_library(DNNL_LIBRARY dnnl)
  find_package(OpenMP QUIET COMPONENTS CXX)
  mark_as_advanced(DNNL_INCLUDE_DIR DNNL_LIBRARY)
  if(DNNL_INCLUDE_DIR AND DNNL_LIBRARY AND OpenMP_CXX_FOUND)
    add_library(dnnl INTERFACE)
    target_include_directories(dnnl SYSTEM INTERFACE ${DNNL_INCLUDE_DIR})
    target_link_libraries(dnnl INTERFACE ${DNNL_LIBRARY} OpenMP::OpenMP_CXX)
  endif()
endif()

if(NOT ODIS_RENDERER)
  return()
endif()
find_package(Imath REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(pugixml REQUIRED)
find_package(fmt REQUIRED)
find_package(ZLIB REQUIRED)
find_package(JPEG REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tinyobjloader REQUIRED)

# Debian 12 has Embree 3, later releases have Embree 4.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()

# Whether it comes with a file for CMake, and with which targets, depends on the release.
find_path(ZSTD_INCLUDE_DIR zstd.h REQUIRED)
find_library(ZSTD_LIBRARY zstd REQUIRED)
mark_as_advanced(ZSTD_INCLUDE_DIR ZSTD_LIBRARY)
add_library(zstd INTERFACE)
target_include_directories(zstd SYSTEM INTERFACE ${ZSTD_INCLUDE_DIR})
target_link_libraries(zstd INTERFACE ${ZSTD_LIBRARY})

# Optional, for training: Debian's libtorch, or that of a PyTorch wheel. Packages for CMake of either ask for CUDA's compiler or
# Python where nothing of them is needed, so the libraries are looked for one by one.
option(ODIS_TRAIN "Build `odis train`, where libtorch is found" ON)
set(ODIS_TORCH "" CACHE PATH "The folder of a PyTorch wheel (.../site-packages/torch), in the place of the system's libtorch")
if(ODIS_TRAIN)
  find_path(TORCH_INCLUDE_DIR torch/csrc/api/include/torch/torch.h HINTS ${ODIS_TORCH}/include)
  find_library(TORCH_CPU_LIBRARY torch_cpu HINTS ${ODIS_TORCH}/lib)
  find_library(C10_LIBRARY c10 HINTS ${ODIS_TORCH}/lib)
  find_library(TORCH_CUDA_LIBRARY torch_cuda HINTS ${ODIS_TORCH}/lib)
  find_library(C10_CUDA_LIBRARY c10_cuda HINTS ${ODIS_TORCH}/lib)
  mark_as_advanced(TORCH_INCLUDE_DIR TORCH_CPU_LIBRARY C10_LIBRARY TORCH_CUDA_LIBRARY C10_CUDA_LIBRARY)
  if(TORCH_INCLUDE_DIR AND TORCH_CPU_LIBRARY AND C10_LIBRARY)
    add_library(torch_learn INTERFACE)
    target_include_directories(torch_learn SYSTEM INTERFACE
      ${TORCH_INCLUDE_DIR} ${TORCH_INCLUDE_DIR}/torch/csrc/api/include)
    target_link_libraries(torch_learn INTERFACE ${TORCH_CPU_LIBRARY} ${C10_LIBRARY})
    # Nothing refers to these; they announce themselves when they are loaded.
    if(TORCH_CUDA_LIBRARY AND C10_CUDA_LIBRARY)
      target_link_libraries(torch_learn INTERFACE
        -Wl,--no-as-needed ${TORCH_CUDA_LIBRARY} ${C10_CUDA_LIBRARY} -Wl,--as-needed)
      # For several processes on CUDA: headers alone, which a wheel has beside it or CUDA's toolkit brings; the library is
      # libtorch's own.
      file(GLOB NVIDIA_INCLUDE_DIRS ${ODIS_TORCH}/../nvidia/*/include)
      find_path(NCCL_INCLUDE_DIR nccl.h HINTS ${NVIDIA_INCLUDE_DIRS})
      find_path(CUDA_RUNTIME_INCLUDE_DIR cuda_runtime_api.h HINTS ${NVIDIA_INCLUDE_DIRS} /usr/local/cuda/include)
      mark_as_advanced(NCCL_INCLUDE_DIR CUDA_RUNTIME_INCLUDE_DIR)
      if(NCCL_INCLUDE_DIR AND CUDA_RUNTIME_INCLUDE_DIR)
        target_include_directories(torch_learn SYSTEM INTERFACE ${NCCL_INCLUDE_DIR} ${CUDA_RUNTIME_INCLUDE_DIR})
        # CUDA_NO_HALF: no type ::half, which is that of Imath here.
        target_compile_definitions(torch_learn INTERFACE ODIS_NCCL USE_C10D_NCCL CUDA_NO_HALF)
      endif()
    endif()
  endif()
endif()
# A wheel has a Gloo of its own and none of its headers, which others' need not fit.
if(TARGET torch_learn AND NOT ODIS_TORCH)
  find_path(GLOO_INCLUDE_DIR gloo/rendezvous/store.h)
  mark_as_advanced(GLOO_INCLUDE_DIR)
  if(GLOO_INCLUDE_DIR)
    target_include_directories(torch_learn SYSTEM INTERFACE ${GLOO_INCLUDE_DIR})
    target_compile_definitions(torch_learn INTERFACE ODIS_GLOO USE_C10D_GLOO)
  endif()
endif()

# Optional, packaged by neither: docs/rivals.md.
find_package(openpgl 0.6 QUIET)

# stb is used as headers, which lie in a folder of its own on Debian, not everywhere.
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
mark_as_advanced(STB_INCLUDE_DIR)
add_library(stb INTERFACE)
target_include_directories(stb SYSTEM INTERFACE ${STB_INCLUDE_DIR})
if(ODIS_APPS)
  find_package(CLI11 REQUIRED)
endif()
