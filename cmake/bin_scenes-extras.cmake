# What find_package(bin_scenes) gives: the target bin_scenes::bin_scenes. Without ROS this is the configuration file
# itself; with ROS, the one that catkin writes includes it.
if(NOT TARGET bin_scenes::bin_scenes)
  include(CMakeFindDependencyMacro)
  find_dependency(Eigen3 NO_MODULE)
  include(${bin_scenes_DIR}/bin_scenesTargets.cmake)
endif()
