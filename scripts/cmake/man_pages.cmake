# Manual pages of the tools, from their --help-all. Skipped if the tools cannot run on this
# machine, or without Python.
find_package(Python3 3.10 COMPONENTS Interpreter)
if(CMAKE_CROSSCOMPILING OR NOT Python3_Interpreter_FOUND)
  return()
endif()
set(man_pages "")
foreach(tool rlpcenc rlpcdec rlpcinfo rlpccmp rlpcval)
  if(NOT TARGET ${tool})
    continue()
  endif()
  set(page ${PROJECT_BINARY_DIR}/man/${tool}.1)
  add_custom_command(OUTPUT ${page}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
    COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/scripts/cmake/man_page.py
            $<TARGET_FILE:${tool}> ${page} --version=${PROJECT_VERSION}
    DEPENDS ${tool} ${PROJECT_SOURCE_DIR}/scripts/cmake/man_page.py
    COMMENT "Writing ${tool}.1" VERBATIM)
  list(APPEND man_pages ${page})
endforeach()
add_custom_target(man_pages ALL DEPENDS ${man_pages})
install(FILES ${man_pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
