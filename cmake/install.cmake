# What a user needs besides programs (their folders install those): share/bin_scenes is also the package's folder for
# ROS, whose tools look there for launch files and, through package://, for models.
if(NOT BIN_SCENES_ROS)
  include(GNUInstallDirs)
  set(share ${CMAKE_INSTALL_DATADIR}/bin_scenes)
else()
  set(share ${CATKIN_PACKAGE_SHARE_DESTINATION})
endif()
install(DIRECTORY shaders DESTINATION ${share} PATTERN test EXCLUDE)
install(DIRECTORY models DESTINATION ${share} FILES_MATCHING PATTERN *.stl PATTERN README.md)
install(FILES LICENSE DESTINATION ${share})
if(BIN_SCENES_ROS)
  install(DIRECTORY launch config DESTINATION ${share})
endif()
