# librlpc.so: the C interface (rlpc.h) over the static libraries. It exports only rlpc_*, so that
# its internals can change.
add_library(rlpc SHARED
  common/c_api/rlpc_status.cpp
  decoder/c_api/rlpc_decode.cpp
  encoder/c_api/rlpc_encode.cpp)
set_source_files_properties(common/c_api/rlpc_status.cpp PROPERTIES
  COMPILE_DEFINITIONS RLPC_VERSION="${PROJECT_VERSION}")
target_link_libraries(rlpc PRIVATE rlpc_decoder rlpc_encoder rlpc_flags)
target_link_options(rlpc PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/scripts/cmake/rlpc.map)
set_target_properties(rlpc PROPERTIES
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/cmake/rlpc.map
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
configure_file(scripts/cmake/rlpc.h.in ${PROJECT_BINARY_DIR}/rlpc.h @ONLY)
