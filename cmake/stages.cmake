# SPDX-License-Identifier: Apache-2.0

# exitance_stage(name DEPENDS earlier stages... LIBRARIES external targets...)
# One folder under src/exitance, one library; it can link only stages declared before it.
function(exitance_stage name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBRARIES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${name}/*.cpp)
  if(sources)
    add_library(exitance_${name} STATIC ${sources})
    target_link_libraries(exitance_${name} PRIVATE exitance_flags)
    set(scope PUBLIC)
  else()  # headers only
    add_library(exitance_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(exitance_${name} ${scope} ${CMAKE_SOURCE_DIR}/src)
  foreach(stage ${ARG_DEPENDS})
    if(NOT TARGET exitance_${stage})
      message(FATAL_ERROR "stage ${name} may only link stages to its left, not ${stage}")
    endif()
    target_link_libraries(exitance_${name} ${scope} exitance_${stage})
  endforeach()
  target_link_libraries(exitance_${name} ${scope} ${ARG_LIBRARIES})
endfunction()
