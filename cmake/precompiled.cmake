# Eigen and the standard containers are half of what the compiler reads in most files; it reads them once for each kind
# of program code instead: `library` (-fPIC), `program` (-fPIE) and `test` (that, and GoogleTest). The first target of a
# kind makes the header, the others take it. Only headers that nobody here edits belong in the list, and every file still
# includes what it uses: -DBIN_SCENES_PRECOMPILED=OFF shows what was forgotten.
option(BIN_SCENES_PRECOMPILED "Parse Eigen and the standard library once" ON)
# Where options of a target do not go with the header, the compiler reads the text instead, as without this file.
set(CMAKE_PCH_WARN_INVALID OFF)

function(bin_scenes_precompile target kind)
  if(NOT BIN_SCENES_PRECOMPILED)
    return()
  endif()
  get_property(first GLOBAL PROPERTY bin_scenes_precompiled_${kind})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
    return()
  endif()
  set(headers <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional>
    <map> <memory> <numeric> <optional> <sstream> <string> <vector>)
  if(kind STREQUAL test)
    list(APPEND headers <gtest/gtest.h>)
  endif()
  target_precompile_headers(${target} PRIVATE ${headers})
  set_property(GLOBAL PROPERTY bin_scenes_precompiled_${kind} ${target})
endfunction()
