# Debian packs OpenCV's parts one by one; only libopencv-dev (a gigabyte with all it pulls in) brings OpenCVConfig.
# find_opencv_part(core) defines the target opencv::core.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
function(find_opencv_part name)
  find_library(OPENCV_${name}_LIBRARY opencv_${name} REQUIRED)
  add_library(opencv::${name} UNKNOWN IMPORTED)
  set_target_properties(opencv::${name} PROPERTIES IMPORTED_LOCATION ${OPENCV_${name}_LIBRARY}
                                                   INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR}
                                                   INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
endfunction()
