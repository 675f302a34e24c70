# What `cmake --install` installs, and the package that find_package(rlpc) and pkg-config find.
# Parts of the project that are not built are skipped.
include(CMakePackageConfigHelpers)

# Builds all that is installed, and no more; used by scripts/quickstart.
add_custom_target(installed_files)
foreach(target rlpc rlpc_static rlpc_dec rlpc_dec_static rlpc_common rlpc_decoder rlpc_encoder rlpcenc rlpcdec rlpcinfo rlpccmp rlpcval
               man_pages)
  if(TARGET ${target})
    add_dependencies(installed_files ${target})
  endif()
endforeach()

set(public_headers "")
foreach(header decoder/rlpc_decoder.h decoder/describe_error.h encoder/rlpc_encoder.h
               encoder/frame_encoder.h)
  get_filename_component(side ${header} DIRECTORY)
  if(TARGET rlpc_${side} AND EXISTS ${PROJECT_SOURCE_DIR}/${header})
    list(APPEND public_headers ${header})
  endif()
endforeach()

if(TARGET rlpc)
  list(APPEND public_headers
       common/c_api/rlpc_clip.h common/c_api/rlpc_status.h decoder/c_api/rlpc_attributes.h
       decoder/c_api/rlpc_c_decoder.h decoder/c_api/rlpc_frame_output.h decoder/c_api/rlpc_pose.h encoder/c_api/rlpc_c_encoder.h)
  foreach(library rlpc rlpc_static rlpc_dec rlpc_dec_static)
    get_target_property(export_name ${library} EXPORT_NAME)
    add_library(rlpc::${export_name} ALIAS ${library})
    if(library MATCHES "_static$")
      # Programs in C link the library of C++ as well.
      set_target_properties(${library} PROPERTIES
        INTERFACE_LINK_LIBRARIES "ZLIB::ZLIB;Threads::Threads;$<$<PLATFORM_ID:Linux>:stdc++>;$<$<PLATFORM_ID:Linux>:m>")
    endif()
    install(TARGETS ${library} EXPORT rlpcTargets
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  endforeach()
  install(FILES ${PROJECT_BINARY_DIR}/rlpc.h ${PROJECT_BINARY_DIR}/rlpcdec.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()

foreach(part common io decoder frame_reader validator encoder)
  if(NOT TARGET rlpc_${part})
    continue()
  endif()
  add_library(rlpc::${part} ALIAS rlpc_${part})
  set_target_properties(rlpc_${part} PROPERTIES EXPORT_NAME ${part})
  target_compile_features(rlpc_${part} PUBLIC cxx_std_20)
  # Flags and header-only libraries are needed to build the archive, not to use it.
  get_target_property(links rlpc_${part} INTERFACE_LINK_LIBRARIES)
  if(links)
    list(FILTER links EXCLUDE REGEX
         "LINK_ONLY:(rlpc_flags|Eigen3::Eigen|CLI11::CLI11|nlohmann_json::nlohmann_json)>")
    set_target_properties(rlpc_${part} PROPERTIES INTERFACE_LINK_LIBRARIES "${links}")
  endif()
  install(TARGETS rlpc_${part} EXPORT rlpcTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()

foreach(tool rlpcenc rlpcdec rlpcinfo rlpccmp rlpcval)
  if(TARGET ${tool})
    install(TARGETS ${tool} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

# Installed only if scripts/player has built it.
install(FILES ${PROJECT_SOURCE_DIR}/build/player/player.html
        DESTINATION ${CMAKE_INSTALL_DATADIR}/rlpc OPTIONAL)

install(CODE "
  set(RLPC_SOURCE_DIR \"${PROJECT_SOURCE_DIR}\")
  set(RLPC_BINARY_DIR \"${PROJECT_BINARY_DIR}\")
  set(RLPC_INCLUDEDIR \"${CMAKE_INSTALL_INCLUDEDIR}\")
  set(RLPC_PUBLIC_HEADERS \"${public_headers}\")")
install(SCRIPT ${PROJECT_SOURCE_DIR}/scripts/cmake/install_headers.cmake)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/rlpc)
install(EXPORT rlpcTargets NAMESPACE rlpc:: DESTINATION ${package_dir})
configure_package_config_file(scripts/cmake/rlpcConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/rlpcConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/rlpcConfigVersion.cmake
                                 COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/rlpcConfig.cmake ${PROJECT_BINARY_DIR}/rlpcConfigVersion.cmake
        DESTINATION ${package_dir})

set(pc_dir ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH RLPC_PC_TO_INCLUDE ${pc_dir} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
# rlpc_pkg_config(NAME WHAT REQUIRES LIBS STATIC_LIBS): the last with --static only
function(rlpc_pkg_config RLPC_PC_NAME RLPC_PC_WHAT RLPC_PC_REQUIRES RLPC_PC_LIBS RLPC_PC_STATIC)
  set(file ${PROJECT_BINARY_DIR}/${RLPC_PC_NAME}.pc)
  configure_file(${PROJECT_SOURCE_DIR}/scripts/cmake/rlpc.pc.in ${file} @ONLY)
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
set(libraries_of_decoder "-lrlpc_decoder")
# It decodes and validates what it has written.
set(libraries_of_encoder "-lrlpc_encoder -lrlpc_frame_reader -lrlpc_validator -lrlpc_decoder")
foreach(side decoder encoder)
  if(TARGET rlpc_${side})
    rlpc_pkg_config(rlpc-${side} "${side} in C++" zlib "${libraries_of_${side}} -lrlpc_io -lrlpc_common -pthread" "")
  endif()
endforeach()
if(TARGET rlpc)
  set(of_static "-lz -lstdc++ -lm -pthread")
  rlpc_pkg_config(rlpc "in C" "" -lrlpc "${of_static}")
  rlpc_pkg_config(rlpcdec "decoder in C" "" -lrlpcdec "${of_static}")
endif()
