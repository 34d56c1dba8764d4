# header-only library; features add the engines alone, whose adapters are always installed
set(VCPKG_BUILD_TYPE release)

# at a release: its repository, and the hash that vcpkg prints
vcpkg_from_github(
    OUT_SOURCE_PATH SOURCE_PATH
    REPO ductile/ductile
    REF "v${VERSION}"
    SHA512 0
    HEAD_REF main
)

vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS
        -DDUCTILE_TESTS=OFF
        -DDUCTILE_BENCH=OFF
        -DDUCTILE_EXAMPLES=OFF
        -DDUCTILE_COMPILED=OFF
)

vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/ductile)
# a .pc file may not require what is not there; vcpkg's Bullet has one .pc file, whatever its precision
set(without "ductile-bullet-float64.pc")
if(NOT "bullet3" IN_LIST FEATURES)
    list(APPEND without "ductile-bullet.pc")
endif()
if(NOT "ode" IN_LIST FEATURES)
    list(APPEND without "ductile-ode.pc")
endif()
list(TRANSFORM without PREPEND "${CURRENT_PACKAGES_DIR}/share/pkgconfig/")
file(REMOVE ${without})
vcpkg_fixup_pkgconfig()

vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
