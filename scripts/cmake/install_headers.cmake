# Install step: the public headers, and the headers of ours that they include, as
# include/rlpc/LAYER/NAME.h. Their includes of one another get the same prefix, since a bare
# "common/result.h" could find a file of the user's project instead.
#
#   RLPC_SOURCE_DIR, RLPC_BINARY_DIR, RLPC_INCLUDEDIR, RLPC_PUBLIC_HEADERS   set by the caller
cmake_policy(VERSION 3.25)
set(queue ${RLPC_PUBLIC_HEADERS})
set(seen "")
while(queue)
  list(POP_FRONT queue header)
  if(header IN_LIST seen)
    continue()
  endif()
  list(APPEND seen ${header})

  file(READ "${RLPC_SOURCE_DIR}/${header}" text)
  string(REGEX MATCHALL "#include \"[^\"]+\"" includes "${text}")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "#include \"(.*)\"" "\\1" included "${include}")
    list(APPEND queue ${included})
  endforeach()
  string(REGEX REPLACE "#include \"([^\"]+)\"" "#include \"rlpc/\\1\"" text "${text}")

  set(staged "${RLPC_BINARY_DIR}/install_headers/${header}")
  set(old "")
  if(EXISTS "${staged}")
    file(READ "${staged}" old)
  endif()
  if(NOT old STREQUAL text)
    file(WRITE "${staged}" "${text}")
  endif()
  get_filename_component(layer "${header}" DIRECTORY)
  file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/${RLPC_INCLUDEDIR}/rlpc/${layer}"
       TYPE FILE FILES "${staged}")
endwhile()
