# How tests become entries of ctest. Each has one label that says what it tests:
#
#   unit     functions and classes, in C++ or C
#   cli      programs as people run them
#   spec     what runs the specification: specdec, rlpcgen, rlpccov
#   judge    the judge of decoders and encoders
#   suite    the conformance streams
#   checks   rules of the project, its headers, its installed package
#   figures  what scripts/compare, scripts/reproduce and scripts/bench write
#   browser  pages in Chromium
#
# More labels: `slow` for tests that take more than three seconds of processor time, which
# `scripts/test --fast` skips; `pure` for tests that run nothing that was built, and need not run
# again with another preset. A test that keeps several processors busy states how many
# (PROCESSORS), and uses no more.
include(GoogleTest)

# The interpreter that scripts run in. The one that was found may be a script of pyenv which looks
# for it, and takes longer than most decodings of specdec.
if(BUILD_TESTING)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sys; print(sys.executable, end='')"
                  OUTPUT_VARIABLE RLPC_PYTHON COMMAND_ERROR_IS_FATAL ANY)
endif()

# What most tests include, compiled once. With g++ alone: the presets of clang prove that sources
# name what they use, and clang-tidy reads their commands before anything is built.
if(BUILD_TESTING AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp CONTENT "int main() {}\n")
  add_executable(rlpc_test_headers ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
  target_precompile_headers(rlpc_test_headers PRIVATE
    <gtest/gtest.h> <algorithm> <array> <cmath> <cstdint> <functional> <memory> <optional>
    <random> <span> <string> <utility> <vector>)
  target_link_libraries(rlpc_test_headers PRIVATE GTest::gtest rlpc_flags)
  target_compile_options(rlpc_test_headers PRIVATE $<$<CONFIG:Release>:-O1>)
endif()

# rlpc_test(NAME SOURCE... LIBS lib...): one GoogleTest binary, each TEST its own entry.
function(rlpc_test name)
  if(NOT BUILD_TESTING)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "LIBS")
  add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest_main rlpc_flags)
  # The code under test is optimised; optimising the tests would take longer than running them.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(TARGET rlpc_test_headers)
    target_precompile_headers(${name} REUSE_FROM rlpc_test_headers)
  endif()
  rlpc_unity(${name})
  gtest_discover_tests(${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS unit)
endfunction()

# rlpc_reads_project(SOURCE...): these know the folder of the project, as RLPC_SOURCE_DIR.
function(rlpc_reads_project)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_DEFINITIONS "RLPC_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\"")
endfunction()

# rlpc_tests(FOLDER... LIBS lib... [EXCEPT name...]): a binary for each folder with all tests in it,
# without the files named; common/codec/mesh has common_codec_mesh_test. One for each file would
# take longer to link than to compile.
function(rlpc_tests)
  cmake_parse_arguments(PARSE_ARGV 0 ARG "" "" "LIBS;EXCEPT")
  foreach(folder IN LISTS ARG_UNPARSED_ARGUMENTS)
    file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cpp)
    if(NOT tests)
      message(FATAL_ERROR "no tests in ${CMAKE_CURRENT_SOURCE_DIR}/${folder}")
    endif()
    foreach(name IN LISTS ARG_EXCEPT)
      list(FILTER tests EXCLUDE REGEX "/${name}.cpp$")
    endforeach()
    if(tests)
      cmake_path(ABSOLUTE_PATH folder NORMALIZE OUTPUT_VARIABLE path)
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      string(REGEX REPLACE "/$" "" path ${path})
      string(REPLACE "/" "_" name ${path})
      rlpc_test(${name}_test ${tests} LIBS ${ARG_LIBS})
    endif()
  endforeach()
endfunction()

# rlpc_python_test(NAME LABEL SCRIPT ARGUMENT... [SLOW] [PURE] [PROCESSORS n]): one entry.
# PURE: it runs nothing that was built. SLOW: see above. specdec keeps its translation of the
# specification for other tests.
function(rlpc_python_test name label script)
  cmake_parse_arguments(PARSE_ARGV 3 ARG "SLOW;PURE" "PROCESSORS" "")
  add_test(NAME ${name} COMMAND ${RLPC_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/${script}
                                ${ARG_UNPARSED_ARGUMENTS})
  set(labels ${label})
  if(ARG_PURE)
    list(APPEND labels pure)
  endif()
  if(ARG_SLOW)
    list(APPEND labels slow)
    set_tests_properties(${name} PROPERTIES COST 10)  # started first, until ctest knows their times
  endif()
  if(ARG_PROCESSORS)
    set_tests_properties(${name} PROPERTIES PROCESSORS ${ARG_PROCESSORS} COST 100)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${labels}"
    ENVIRONMENT RLPC_SPECDEC_CACHE=${PROJECT_BINARY_DIR}/specdec)
endfunction()

# rlpc_python_tests(PREFIX LABEL SCRIPT CLASS... [SLOW class...]): one entry for each class of a
# script that takes --bin, the folder of the programs.
function(rlpc_python_tests prefix label script)
  cmake_parse_arguments(PARSE_ARGV 3 ARG "" "" "SLOW")
  foreach(class IN LISTS ARG_UNPARSED_ARGUMENTS ARG_SLOW)
    set(slow "")
    if(class IN_LIST ARG_SLOW)
      set(slow SLOW)
    endif()
    rlpc_python_test(${prefix}.${class} ${label} ${script}
                     --bin ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${class} ${slow})
  endforeach()
endfunction()
