# Messages and package metadata for catkin, which wants them declared from the folder of package.xml. Sets
# BIN_SCENES_CATKIN_* for src/ros and test/ros; no other target sees a ROS header.

# What scripts/, models/ and bench/ hold is run in the source and build folders.
#catkin_lint: ignore uninstalled_script uninstalled_target
# A layer's private headers are named without its folder, tests of another layer name them with it.
#catkin_lint: ignore ambiguous_include_path

find_package(catkin REQUIRED COMPONENTS
  actionlib actionlib_msgs diagnostic_updater dynamic_reconfigure geometry_msgs message_generation nodelet
  rosbag_storage roscpp roslib sensor_msgs std_msgs std_srvs tf2_msgs topic_tools visualization_msgs)
if(BIN_SCENES_PCL)  # for the example icp_check alone; the rest of src/ros does without PCL's headers
  find_package(pcl_conversions REQUIRED)
  find_package(resource_retriever REQUIRED)
  find_package(tf2_ros REQUIRED)
endif()

if(BIN_SCENES_PYTHON)
  # The package of the messages is ours, too (src/python): this is how catkin_python_setup() tells the generators that
  # its __init__.py is there. That macro itself would install by a setup.py.
  set(${PROJECT_NAME}_CATKIN_PYTHON_SETUP_HAS_PACKAGE_INIT TRUE)
endif()
add_message_files(FILES
  Bin.msg Counter.msg Drift.msg Energy.msg ErrorCode.msg Flag.msg Motion.msg PartLine.msg Penetration.msg Quantiles.msg Scene.msg
  ScenePart.msg SceneReport.msg SceneRequest.msg Sensor.msg StageTime.msg Surface.msg Table.msg Worst.msg)
add_service_files(FILES AddParts.srv GenerateScene.srv GetGrasps.srv PickPart.srv)
add_action_files(FILES GenerateScene.action)
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs std_msgs)
generate_dynamic_reconfigure_options(cfg/BinScenes.cfg)

# The library (cmake/library.cmake) and the messages; bin_scenes-extras.cmake adds the target bin_scenes::bin_scenes.
catkin_package(INCLUDE_DIRS include LIBRARIES bin_scenes CATKIN_DEPENDS actionlib_msgs geometry_msgs message_runtime std_msgs
  DEPENDS EIGEN3 CFG_EXTRAS bin_scenes-extras.cmake)

# catkin gives its include path and definitions to every target of the project. Only those of src/ros and test/ros take
# them: a stray include does not compile, and the rest compiles to the same objects with and without ROS.
get_directory_property(BIN_SCENES_CATKIN_DEFINITIONS COMPILE_DEFINITIONS)
get_directory_property(BIN_SCENES_CATKIN_INCLUDES INCLUDE_DIRECTORIES)
set_directory_properties(PROPERTIES COMPILE_DEFINITIONS "" INCLUDE_DIRECTORIES "")

# catkin sends every library and program of the project to its development space. Only what rosrun has to find goes
# there (src/ros); a build with ROS leaves the rest where a build without ROS does.
unset(CMAKE_ARCHIVE_OUTPUT_DIRECTORY)
unset(CMAKE_LIBRARY_OUTPUT_DIRECTORY)
unset(CMAKE_RUNTIME_OUTPUT_DIRECTORY)

# rosrun looks for programs below the package, but never in a folder `build` there, where this development space lies
# unless it belongs to a workspace. It finds them through a link beside it.
string(FIND "${CATKIN_DEVEL_PREFIX}/" "${PROJECT_SOURCE_DIR}/build/" inside_build)
if(inside_build EQUAL 0)
  file(CREATE_LINK ${CATKIN_DEVEL_PREFIX} ${PROJECT_SOURCE_DIR}/devel SYMBOLIC)
endif()
