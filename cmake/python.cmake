# Debian's Python: ROS 1 and numpy live in it. Another python3 first on the PATH knows neither empy nor genmsg.
if(EXISTS /usr/bin/python3)
  foreach(variable PYTHON_EXECUTABLE Python3_EXECUTABLE)
    if(NOT ${variable})
      set(${variable} /usr/bin/python3 CACHE FILEPATH "Python of ROS 1 and of the module bin_scenes")
    endif()
  endforeach()
endif()

if(BIN_SCENES_SANITIZE OR BIN_SCENES_FUZZ)
  set(BIN_SCENES_PYTHON OFF)  # a module with sanitizers needs an interpreter with them
endif()
if(BIN_SCENES_PYTHON)
  find_package(pybind11 2.6 QUIET CONFIG)
  if(NOT pybind11_FOUND)
    message(STATUS "pybind11 2.6 not found: no Python module is built (pybind11-dev)")
    set(BIN_SCENES_PYTHON OFF)
  endif()
endif()
