# The libraries in C, each shared and static:
#
#   rlpc, rlpc_static           librlpc: encoder and decoder, over the static libraries in C++
#   rlpc_dec, rlpc_dec_static   librlpcdec: the decoder alone, compiled for size
#
# The shared ones export only rlpc_*, so that their internals can change. The static ones contain
# all that they need of this project, and hide it from whoever links them.
rlpc_sources(c_of_common common/c_api common/memory)
rlpc_sources(c_of_decoder decoder/c_api)
rlpc_sources(c_of_encoder encoder/c_api)
set(map ${PROJECT_SOURCE_DIR}/scripts/cmake/rlpc.map)

# rlpc_c_library(NAME FILE SHARED|STATIC SOURCE...)
function(rlpc_c_library name file kind)
  add_library(${name} ${kind} ${ARGN})
  target_compile_definitions(${name} PRIVATE RLPC_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${name} PRIVATE rlpc_flags)
  string(REPLACE "rlpc_dec" "rlpcdec" export_name ${name})
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME ${file}
    EXPORT_NAME ${export_name}
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  if(kind STREQUAL "STATIC")
    target_compile_definitions(${name} PUBLIC RLPC_STATIC)
    return()
  endif()
  target_compile_definitions(${name} PRIVATE RLPC_BUILDING)
  target_link_options(${name} PRIVATE LINKER:--version-script=${map} LINKER:--gc-sections)
  set_target_properties(${name} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} LINK_DEPENDS ${map})
endfunction()

rlpc_c_library(rlpc rlpc SHARED ${c_of_common} ${c_of_decoder} ${c_of_encoder})
target_link_libraries(rlpc PRIVATE rlpc_decoder rlpc_encoder)

rlpc_c_library(rlpc_static rlpc STATIC ${c_of_common} ${c_of_decoder} ${c_of_encoder}
  $<TARGET_OBJECTS:rlpc_common> $<TARGET_OBJECTS:rlpc_io> $<TARGET_OBJECTS:rlpc_decoder>
  $<TARGET_OBJECTS:rlpc_encoder> $<TARGET_OBJECTS:rlpc_frame_reader>
  $<TARGET_OBJECTS:rlpc_validator>)
target_link_libraries(rlpc_static PRIVATE ZLIB::ZLIB Threads::Threads)

rlpc_unity(rlpc)
rlpc_unity(rlpc_static)

# Without the writers of mesh files. Memory can come from callbacks, so containers are others, and
# so is the namespace: programs may link the libraries in C++ as well.
get_target_property(of_decoder rlpc_decoder SOURCES)
list(FILTER of_decoder EXCLUDE REGEX "/decoder/meshes/")
get_target_property(of_common rlpc_common SOURCES)
get_target_property(of_io rlpc_io SOURCES)
list(FILTER of_io INCLUDE REGEX "/bounded_input\\.cpp$")
# Compiled once for both; only the files of the interface differ, in what they export.
add_library(rlpc_dec_objects OBJECT ${of_common} ${of_decoder} ${of_io})
target_link_libraries(rlpc_dec_objects PRIVATE ZLIB::ZLIB Threads::Threads rlpc_flags)
target_compile_definitions(rlpc_dec_objects PRIVATE RLPC_VERSION="${PROJECT_VERSION}")
set_target_properties(rlpc_dec_objects PROPERTIES POSITION_INDEPENDENT_CODE ON)

rlpc_c_library(rlpc_dec rlpcdec SHARED ${c_of_common} ${c_of_decoder}
  $<TARGET_OBJECTS:rlpc_dec_objects>)
rlpc_c_library(rlpc_dec_static rlpcdec STATIC ${c_of_common} ${c_of_decoder}
  $<TARGET_OBJECTS:rlpc_dec_objects>)
foreach(name rlpc_dec rlpc_dec_static)
  target_link_libraries(${name} PRIVATE ZLIB::ZLIB Threads::Threads)
endforeach()
foreach(name rlpc_dec_objects rlpc_dec rlpc_dec_static)
  target_compile_definitions(${name} PRIVATE RLPC_OWNED_MEMORY rlpc=rlpc_decoder_alone)
  # CONTRIBUTING.md says what each is worth.
  target_compile_options(${name} PRIVATE
    $<$<CONFIG:Release>:-Os> -ffunction-sections -fdata-sections)
endforeach()

foreach(name rlpc_dec_objects rlpc_dec rlpc_dec_static)
  rlpc_unity(${name})
endforeach()

# The shared library is optimised at the link step. What the objects carry for it is removed from
# the static one, which other compilers must be able to link.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  foreach(name rlpc_dec_objects rlpc_dec)
    target_compile_options(${name} PRIVATE -flto=auto -ffat-lto-objects)
  endforeach()
  target_link_options(rlpc_dec PRIVATE -flto=auto -flto-partition=one -Os)
  add_custom_command(TARGET rlpc_dec_static POST_BUILD VERBATIM
    COMMAND ${CMAKE_OBJCOPY} --remove-section=.gnu.lto_* --remove-section=.gnu.debuglto_*
      $<TARGET_FILE:rlpc_dec_static>)
endif()

configure_file(scripts/cmake/rlpc.h.in ${PROJECT_BINARY_DIR}/rlpc.h @ONLY)
configure_file(scripts/cmake/rlpcdec.h.in ${PROJECT_BINARY_DIR}/rlpcdec.h @ONLY)
