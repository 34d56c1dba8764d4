# Where the CMake package and the .pc files go: headers alone are the same on every machine and belong
# under share, compiled libraries under lib.
if(DUCTILE_COMPILED)
  set(DUCTILE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ductile)
  set(DUCTILE_PKGCONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
else()
  set(DUCTILE_CMAKE_DIR ${CMAKE_INSTALL_DATADIR}/cmake/ductile)
  set(DUCTILE_PKGCONFIG_DIR ${CMAKE_INSTALL_DATADIR}/pkgconfig)
endif()
