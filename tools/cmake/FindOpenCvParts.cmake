# The OpenCV modules that rangepose uses, as OpenCvParts::core, ::imgproc, ::imgcodecs and ::calib3d.
#
# Debian's small packages (libopencv-core-dev, libopencv-imgproc-dev, libopencv-imgcodecs-dev, libopencv-calib3d-dev) hold headers and
# libraries; OpenCV's own CMake package comes only with libopencv-dev, which draws in some hundred others.

find_path(OpenCvParts_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
set(_opencv_libraries)
foreach(part core imgproc imgcodecs calib3d)
  find_library(OpenCvParts_${part}_LIBRARY opencv_${part})
  list(APPEND _opencv_libraries OpenCvParts_${part}_LIBRARY)
endforeach()
mark_as_advanced(OpenCvParts_INCLUDE_DIR ${_opencv_libraries})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCvParts
  REQUIRED_VARS OpenCvParts_INCLUDE_DIR ${_opencv_libraries}
  REASON_FAILURE_MESSAGE "install libopencv-core-dev, libopencv-imgproc-dev, libopencv-imgcodecs-dev and libopencv-calib3d-dev")

if(OpenCvParts_FOUND)
  foreach(part core imgproc imgcodecs calib3d)
    if(NOT TARGET OpenCvParts::${part})
      add_library(OpenCvParts::${part} UNKNOWN IMPORTED)
      set_target_properties(OpenCvParts::${part} PROPERTIES
        IMPORTED_LOCATION "${OpenCvParts_${part}_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${OpenCvParts_INCLUDE_DIR}")
    endif()
  endforeach()
endif()
