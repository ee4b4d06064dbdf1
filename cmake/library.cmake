# bin_scenes::bin_scenes, what other projects link: one shared library of all layers but dataset, tool and node. It hides what
# the layers use themselves (assimp, Bullet, PCL, ...): its headers, and so its users, need Eigen alone, and none of our
# compiler flags reach them.
include(GNUInstallDirs)
set(objects)
set(libraries)
foreach(layer core scene gl mesh part sphere sphere_gl bullet thesis solver pour quality raster light sensor grasp config output bop generate)
  list(APPEND objects $<TARGET_OBJECTS:bin_scenes_${layer}>)
  list(APPEND libraries bin_scenes_${layer})
endforeach()
add_library(bin_scenes SHARED ${objects})
add_library(bin_scenes::bin_scenes ALIAS bin_scenes)
# The layers are in it already as objects; they are named for the libraries that they use.
target_link_libraries(bin_scenes PUBLIC Eigen3::Eigen PRIVATE ${libraries})
target_compile_features(bin_scenes PUBLIC cxx_std_17)
target_include_directories(bin_scenes PUBLIC
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
# A program compiled with other flags holds other copies of the same inline functions of Eigen. The library calls its
# own: its results do not depend on who links it.
target_link_options(bin_scenes PRIVATE -Wl,-Bsymbolic-functions)
set_target_properties(bin_scenes PROPERTIES LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

install(DIRECTORY include/bin_scenes DESTINATION include COMPONENT tool FILES_MATCHING PATTERN *.hpp)
if(BIN_SCENES_ROS)
  # find_package() reads the file that catkin writes (bin_scenesConfig.cmake, with its version), and that the targets.
  set(libraries ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(package ${CATKIN_PACKAGE_SHARE_DESTINATION}/cmake)
  set_target_properties(bin_scenes PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${libraries})
  set(development ${CATKIN_DEVEL_PREFIX}/share/bin_scenes/cmake)
else()
  set(libraries ${CMAKE_INSTALL_LIBDIR})
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/bin_scenes)
  set(development ${PROJECT_BINARY_DIR}/cmake)
  include(CMakePackageConfigHelpers)
  configure_file(cmake/bin_scenes-extras.cmake ${development}/bin_scenesConfig.cmake COPYONLY)
  write_basic_package_version_file(${development}/bin_scenesConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  #catkin_lint: ignore_once missing_file wrong_install_destination
  install(FILES ${development}/bin_scenesConfig.cmake ${development}/bin_scenesConfigVersion.cmake
    DESTINATION ${package})
endif()
install(TARGETS bin_scenes EXPORT bin_scenes DESTINATION ${libraries} COMPONENT tool)
install(EXPORT bin_scenes NAMESPACE bin_scenes:: FILE bin_scenesTargets.cmake DESTINATION ${package})
export(EXPORT bin_scenes NAMESPACE bin_scenes:: FILE ${development}/bin_scenesTargets.cmake)
