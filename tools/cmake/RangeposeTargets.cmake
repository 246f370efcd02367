# Targets of the project: one library a folder, one test binary a folder.

find_program(RANGEPOSE_CCACHE ccache)
if(RANGEPOSE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${RANGEPOSE_CCACHE})
endif()

function(rangepose_compile_options target)
  # No contraction: a*b+c rounds the same way with and without FMA, so that results do not depend on the
  # processor that the dispatcher finds.
  set(options -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off)
  if(RANGEPOSE_WERROR)
    list(APPEND options -Werror)
  endif()
  if(RANGEPOSE_SANITIZE)
    list(APPEND options -fsanitize=${RANGEPOSE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  endif()
  # nvcc is told the same in its own words.
  set(cuda_options -Xcompiler=-Wall,-Wextra,-ffp-contract=off -fmad=false -lineinfo)
  if(RANGEPOSE_WERROR)
    list(APPEND cuda_options -Werror=all-warnings)
  endif()
  target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:${options}>"
                                           "$<$<COMPILE_LANGUAGE:CUDA>:${cuda_options}>")
  if(RANGEPOSE_SANITIZE)
    target_link_options(${target} PUBLIC -fsanitize=${RANGEPOSE_SANITIZE})
  endif()
endfunction()

# rangepose_library(name SOURCES a.cpp ... LINK other ...)
function(rangepose_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(rangepose_${name} STATIC ${ARG_SOURCES})
  add_library(rangepose::${name} ALIAS rangepose_${name})
  target_include_directories(rangepose_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(rangepose_${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK})
  rangepose_compile_options(rangepose_${name})
endfunction()

# What runs longer hangs. No test takes more than some 20 s of a core, ten times that under sanitizers; the
# rest is for machines that are busy with other work: a test must not fail for want of a core.
set(RANGEPOSE_HANG_SECONDS 7200)

# rangepose_test(name LABEL label SOURCES a.cpp ... LINK other ...)
function(rangepose_test name)
  cmake_parse_arguments(ARG "" "LABEL" "SOURCES;LINK" ${ARGN})
  add_executable(rangepose_${name}_test ${ARG_SOURCES})
  target_include_directories(rangepose_${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(rangepose_${name}_test PRIVATE ${ARG_LINK} GTest::gmock_main)
  target_compile_definitions(rangepose_${name}_test PRIVATE
    RP_SOURCE_DIR="${PROJECT_SOURCE_DIR}" RP_MODELS_DIR="${PROJECT_SOURCE_DIR}/models")
  rangepose_compile_options(rangepose_${name}_test)
  gtest_discover_tests(rangepose_${name}_test TEST_PREFIX "${name}/" DISCOVERY_TIMEOUT ${RANGEPOSE_HANG_SECONDS}
                       PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${RANGEPOSE_HANG_SECONDS})
endfunction()
