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

# add_room(name SOURCES ... USES rooms that its headers show ... LIBRARIES its own third-party doors ...)
function(add_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LIBRARIES" ${ARGN})
  add_library(tumble_${name} STATIC ${ROOM_SOURCES})
  list(TRANSFORM ROOM_USES PREPEND tumble_)
  target_link_libraries(tumble_${name} PUBLIC tumble_options ${ROOM_USES} PRIVATE ${ROOM_LIBRARIES})
endfunction()
