# Debian packages by CPack; scripts/package makes them. What our files do not name belongs to the node: catkin's files and
# the messages.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # neither benchmarks nor tests are packed
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bin-scenes)
set(CPACK_PACKAGE_VERSION ${BIN_SCENES_PACKAGE_VERSION})
set(CPACK_PACKAGE_CONTACT "bin_scenes developers <bin_scenes@example.org>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/tidy_package.cmake)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL tool data node python)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

# bin_scenes_package(<component> <name> <one line> <description>)
macro(bin_scenes_package component name summary text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  # In Debian's format the first line is the summary.
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}")
  install(DIRECTORY ${PROJECT_BINARY_DIR}/doc/${name} DESTINATION share/doc COMPONENT ${component})
endmacro()
bin_scenes_package(tool bin-scenes "simulated bins of CAD parts for bin picking"
  "Pours parts into a bin, judges the heap on the true meshes, and measures it\nby range sensors: the command line, the library and its headers.")
bin_scenes_package(data bin-scenes-data "simulated bins of CAD parts for bin picking (models and presets)"
  "Sample models, sensor presets, materials and example requests.")
bin_scenes_package(node bin-scenes-ros "simulated bins of CAD parts for bin picking (ROS node)"
  "Node, nodelet, messages and launch files for ROS 1.")
bin_scenes_package(python python3-bin-scenes "simulated bins of CAD parts for bin picking (Python)"
  "The module bin_scenes, which makes scenes, and the reader of data sets.")

# What no shared library tells. OpenGL is opened by name, and works without a GPU by Mesa's drivers.
set(exactly "(= ${CPACK_PACKAGE_VERSION})")
find_package(Python3 COMPONENTS Interpreter REQUIRED)
math(EXPR python_minor_after "${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_TOOL_PACKAGE_DEPENDS "bin-scenes-data ${exactly}, libegl1, libopengl0, libgl1-mesa-dri")
set(CPACK_DEBIAN_TOOL_PACKAGE_RECOMMENDS
  "libjs-three, python3-numpy, python3-scipy, python3-sklearn, python3-pil")  # the 3-D view of `view` and of reports; `realism`
set(CPACK_DEBIAN_TOOL_PACKAGE_SUGGESTS "bin-scenes-ros, python3-bin-scenes")
set(CPACK_DEBIAN_DATA_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_NODE_PACKAGE_DEPENDS
  "bin-scenes ${exactly}, python3-bin-scenes ${exactly}, python3, python3-genpy, python3-actionlib, python3-actionlib-msgs, python3-geometry-msgs, python3-sensor-msgs, python3-std-msgs, python3-std-srvs, python3-tf2-msgs, python3-visualization-msgs, python3-rosbag, python3-roslaunch, python3-rospy, python3-rosservice, python3-rostopic, rosout, rosbash")
# roslaunch looks up the machine's own name, which a bare root or container does not know.
set(CPACK_DEBIAN_NODE_PACKAGE_RECOMMENDS libnss-myhostname)
set(CPACK_DEBIAN_NODE_PACKAGE_SUGGESTS rviz)
# A compiled module fits one version of Python.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "bin-scenes ${exactly}, python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3 (<< ${Python3_VERSION_MAJOR}.${python_minor_after}), python3-numpy, python3-pil")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# As debhelper does it, instead of scripts that call ldconfig.
file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_TOOL_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_NODE_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
include(CPack)
