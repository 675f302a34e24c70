# Toolchain of the presets `sanitize`, `tsan`, `msan` and `fuzz`: the clang that the project is
# tested with, otherwise whichever is installed. `cmake --preset sanitize
# -DCMAKE_CXX_COMPILER=g++` overrides it.
if(NOT CMAKE_CXX_COMPILER)
  find_program(RLPC_CLANG NAMES clang++-14 clang++ REQUIRED)
  set(CMAKE_CXX_COMPILER ${RLPC_CLANG})
endif()
if(NOT CMAKE_C_COMPILER)  # for C programs that use the library
  find_program(RLPC_CLANG_C NAMES clang-14 clang REQUIRED)
  set(CMAKE_C_COMPILER ${RLPC_CLANG_C})
endif()
