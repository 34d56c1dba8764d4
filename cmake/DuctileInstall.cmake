# Installs headers, CMake package and .pc files, those of every adapter, whether its engine is here or
# not; adapters/CMakeLists.txt installs what was compiled. `cpack` makes libductile-dev of it.
include(CMakePackageConfigHelpers)

install(DIRECTORY include/ adapters/bullet/include/ adapters/ode/include/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.ipp")

# ---- the CMake package -----------------------------------------------------------------------------
install(TARGETS ductile EXPORT ductileTargets)
install(EXPORT ductileTargets NAMESPACE ductile:: DESTINATION ${DUCTILE_CMAKE_DIR})
configure_package_config_file(cmake/ductileConfig.cmake.in ductileConfig.cmake
                              INSTALL_DESTINATION ${DUCTILE_CMAKE_DIR}
                              NO_CHECK_REQUIRED_COMPONENTS_MACRO)
set(any_architecture ARCH_INDEPENDENT)
if(DUCTILE_COMPILED)
  set(any_architecture "")
endif()
write_basic_package_version_file(ductileConfigVersion.cmake COMPATIBILITY SameMinorVersion
                                 ${any_architecture})
install(FILES ${PROJECT_BINARY_DIR}/ductileConfig.cmake
              ${PROJECT_BINARY_DIR}/ductileConfigVersion.cmake
              cmake/DuctileEngines.cmake
        DESTINATION ${DUCTILE_CMAKE_DIR})

# ---- pkg-config --------------------------------------------------------------------------------------
file(RELATIVE_PATH up /${DUCTILE_PKGCONFIG_DIR} /)
string(REGEX REPLACE "/$" "" up "${up}")
function(ductile_pc name description requires cflags)
  configure_file(cmake/ductile.pc.in ${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${DUCTILE_PKGCONFIG_DIR})
endfunction()
ductile_pc(ductile "${PROJECT_DESCRIPTION}" "eigen3 >= 3.4" "")
ductile_pc(ductile-bullet "ductile's adapter for Bullet in single precision" "ductile bullet"
           " -DDUCTILE_BULLET_DOUBLE=0")
ductile_pc(ductile-bullet-float64 "ductile's adapter for Bullet in double precision"
           "ductile bullet-float64" " -DDUCTILE_BULLET_DOUBLE=1")
ductile_pc(ductile-ode "ductile's adapter for ODE" "ductile ode" "")

# ---- a Debian package --------------------------------------------------------------------------------
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME libductile-dev)
  set(CPACK_PACKAGE_CONTACT "the ductile authors <ductile@example.org>")
  set(CPACK_PACKAGE_DESCRIPTION
      "Joints that bend, absorb energy and break the way steel does: headers of the
 core and of the adapters for Bullet and ODE.")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_VERBATIM_VARIABLES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libbullet-dev, libode-dev")
  if(NOT DUCTILE_COMPILED)
    set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
  endif()
  # Debian wants the licence here; other installs have their own place for it
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libductile-dev RENAME copyright
          COMPONENT debian EXCLUDE_FROM_ALL)
  set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR}" ductile ALL /
                                   "${PROJECT_BINARY_DIR}" ductile debian /)
  include(CPack)
endif()
