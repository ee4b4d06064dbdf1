# OpenCASCADE, which reads STEP and IGES. Its documents (TKXDESTEP) are left out: they bring viewers into every program.
set(OCCT_LIBRARIES)
if(BIN_SCENES_CAD)
  find_path(OCCT_INCLUDE_DIR STEPControl_Reader.hxx PATH_SUFFIXES opencascade)
  find_library(OCCT_LIBRARY TKSTEP)
  if(OCCT_INCLUDE_DIR AND OCCT_LIBRARY)
    set(OCCT_LIBRARIES TKSTEP TKSTEPBase TKIGES TKXSBase TKMesh TKShHealing TKBO TKTopAlgo TKBRep TKGeomBase TKG3d TKG2d
      TKMath TKernel)
  else()
    message(STATUS "OpenCASCADE not found: STEP and IGES are not read (libocct-data-exchange-dev)")
  endif()
endif()
