# Run by CPack on the files of its packages before it packs them.
# Compiled Python belongs to the machine where it is installed.
file(GLOB_RECURSE found LIST_DIRECTORIES true ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*/__pycache__)
foreach(folder ${found})
  if(folder MATCHES "__pycache__$")
    file(REMOVE_RECURSE ${folder})
  endif()
endforeach()
# rosrun looks for the command line there; the package has one copy of it.
set(second ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/node/usr/lib/bin_scenes/bin_scenes)
if(EXISTS ${second})
  file(REMOVE ${second})
  file(CREATE_LINK ../../bin/bin_scenes ${second} SYMBOLIC)
endif()
# The module and the messages are one package of Python, which catkin installs whole: what the module has, it has alone.
set(folder usr/lib/python3/dist-packages/bin_scenes)
file(GLOB found RELATIVE ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/python/${folder}
  ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/python/${folder}/*)
foreach(name ${found})
  file(REMOVE ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/node/${folder}/${name})
endforeach()
# The licence is the package's copyright file.
file(GLOB found ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*/usr/share/bin_scenes/LICENSE)
if(found)
  file(REMOVE ${found})
endif()
