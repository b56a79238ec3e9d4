# What every room shares: C++20, includes from the repository root, the warnings, and arithmetic that is the same
# in every build (no contraction: same input and seed, same bytes).
set(CMAKE_CXX_EXTENSIONS OFF)

add_library(tumble_options INTERFACE)
target_compile_features(tumble_options INTERFACE cxx_std_20)
target_include_directories(tumble_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(tumble_options INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                                -Wno-sign-conversion)
if(TUMBLE_WARNINGS_AS_ERRORS)
  target_compile_options(tumble_options INTERFACE -Werror)
endif()

# The headers that most sources of a target read, parsed once. Never together with a compiler cache: what gcc precompiles differs
# from build to build, so that nothing would be found in the cache again. Of strings that come out of a precompiled header
# gcc 12 reports overruns that are none (a library's inlined code counts as ours then): those warnings are off there, and on in
# every build without precompiled headers.
option(TUMBLE_PRECOMPILED "Precompile heavy headers, unless a compiler cache is used" OFF)
function(precompile target)
  if(TUMBLE_PRECOMPILED AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} PRIVATE <algorithm> <cmath> <filesystem> <functional> <map> <random> <string> <vector> ${ARGN})
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overread -Wno-stringop-overflow)
  endif()
endfunction()

# For what computes next to nothing itself: a quarter less to compile.
function(optimise_lightly)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()

# add_room(name SOURCES ... USES rooms that its headers show ... LIBRARIES its own third-party doors ... PRECOMPILED their heavy headers ...)
function(add_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES;PRECOMPILED" ${ARGN})
  add_library(tumble_${name} STATIC ${ROOM_SOURCES})
  list(TRANSFORM ROOM_USES PREPEND tumble_)
  target_link_libraries(tumble_${name} PUBLIC tumble_options ${ROOM_USES} PRIVATE ${ROOM_LIBRARIES})
  precompile(tumble_${name} ${ROOM_PRECOMPILED})

  # Every header compiles alone: `cmake --build build/release --target check_headers` gives each a source file.
  file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS *.h)
  foreach(header IN LISTS headers)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/alone/${header}.cpp CONTENT "#include \"${header}\"\n")
    list(APPEND alone ${CMAKE_CURRENT_BINARY_DIR}/alone/${header}.cpp)
  endforeach()
  add_library(headers_of_${name} OBJECT EXCLUDE_FROM_ALL ${alone})
  target_compile_options(headers_of_${name} PRIVATE -O0)
  target_link_libraries(headers_of_${name} PRIVATE tumble_${name} ${ROOM_LIBRARIES})
  if(NOT TARGET check_headers)
    add_custom_target(check_headers)
  endif()
  add_dependencies(check_headers headers_of_${name})
endfunction()
