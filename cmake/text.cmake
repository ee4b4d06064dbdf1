# bin_scenes_text(<name> <file> [<mark> <file>]...)
# A file as a text in the program, which needs no file beside it then: the constant `extern const char* const <name>` of
# the namespace bin_scenes, in the source ${CMAKE_CURRENT_BINARY_DIR}/<name>.cpp. Further files take the place of their
# marks.
function(bin_scenes_text text_name text_file)
  file(READ ${text_file} text)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${text_file})
  while(ARGN)
    list(POP_FRONT ARGN mark inserted)
    file(READ ${inserted} insert)
    string(REPLACE "${mark}" "${insert}" text "${text}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${inserted})
  endwhile()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/text.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${text_name}.cpp @ONLY)
endfunction()
