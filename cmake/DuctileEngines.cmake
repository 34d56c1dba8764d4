# What the CMake targets of the adapters are made of. The build of this project and the package that it
# installs read this one file, so that both give the same targets.
#
#   adapter          engine                                 a target of yours instead of a search
#   bullet           Bullet in single precision             DUCTILE_BULLET_TARGET
#   bullet_float64   Bullet in double precision             DUCTILE_BULLET_FLOAT64_TARGET
#   ode              ODE                                    DUCTILE_ODE_TARGET
#
# Without such a target pkg-config is asked, then the engine's own CMake package.
set(DUCTILE_ADAPTERS bullet bullet_float64 ode)

# Makes the imported target ductile_engine::<adapter> and sets <missing> to "", or to one line that says
# what is missing. GLOBAL as the third argument makes it known beyond the calling folder.
function(ductile_find_engine adapter missing)
  set(${missing} "" PARENT_SCOPE)
  if(TARGET ductile_engine::${adapter})
    return()
  endif()
  string(TOUPPER DUCTILE_${adapter}_TARGET choice)
  if(NOT "${${choice}}" STREQUAL "")
    foreach(target IN LISTS ${choice})
      if(NOT TARGET ${target})
        set(${missing} "${choice} names ${target}, which is not a target here" PARENT_SCOPE)
        return()
      endif()
    endforeach()
    set(libraries ${${choice}})
    set(includes "")
    set(definitions "")
  else()
    if(adapter STREQUAL "ode")
      _ductile_find_ode()
      set(wanted "ODE (pkg-config module ode, CMake package ode)")
    elseif(adapter STREQUAL "bullet")
      _ductile_find_bullet(OFF)
      set(wanted "Bullet in single precision (pkg-config module bullet, CMake package Bullet)")
    else()
      _ductile_find_bullet(ON)
      set(wanted "Bullet in double precision (pkg-config module bullet-float64, CMake package Bullet)")
    endif()
    if(NOT libraries)
      set(${missing} "${wanted} not found, and ${choice} names no target of yours" PARENT_SCOPE)
      return()
    endif()
  endif()
  add_library(ductile_engine::${adapter} INTERFACE IMPORTED ${ARGV2})
  # an imported target's headers are system headers for who links it: not ours to warn about
  target_include_directories(ductile_engine::${adapter} INTERFACE ${includes})
  target_compile_definitions(ductile_engine::${adapter} INTERFACE ${definitions})
  target_link_libraries(ductile_engine::${adapter} INTERFACE ${libraries})
endfunction()

# Gives <target>, an INTERFACE library, what the adapter's headers need beside their own folder.
function(ductile_adapter_needs target adapter)
  target_link_libraries(${target} INTERFACE ductile::ductile ductile_engine::${adapter})
  if(adapter STREQUAL "bullet")
    set(double 0)
    set(precision single)
  elseif(adapter STREQUAL "bullet_float64")
    set(double 1)
    set(precision double)
    target_compile_definitions(${target} INTERFACE BT_USE_DOUBLE_PRECISION)
  else()
    return()
  endif()
  # refuses a program that links both precisions, when CMake generates it; and one that links this and
  # defines or undefines BT_USE_DOUBLE_PRECISION itself, when it compiles
  set_target_properties(${target} PROPERTIES
    INTERFACE_DUCTILE_BULLET_PRECISION ${precision}
    COMPATIBLE_INTERFACE_STRING DUCTILE_BULLET_PRECISION)
  target_compile_definitions(${target} INTERFACE DUCTILE_BULLET_DOUBLE=${double})
endfunction()

# ---- the searches set libraries, includes and definitions of their caller; libraries is empty where
# nothing was found ---------------------------------------------------------------------------------

# Asks pkg-config for <module>.
macro(_ductile_ask_pkg_config prefix module)
  set(libraries "")
  set(includes "")
  set(definitions "")
  find_package(PkgConfig QUIET)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(${prefix} QUIET ${module})
    if(${prefix}_FOUND)
      set(libraries ${${prefix}_LINK_LIBRARIES})
      set(includes ${${prefix}_INCLUDE_DIRS})
      set(definitions ${${prefix}_CFLAGS_OTHER})
      list(FILTER definitions INCLUDE REGEX "^-D")
      list(TRANSFORM definitions REPLACE "^-D" "")
    endif()
  endif()
endmacro()

macro(_ductile_find_ode)
  _ductile_ask_pkg_config(DUCTILE_PC_ODE ode)
  if(NOT libraries)
    find_package(ode CONFIG QUIET)
    if(TARGET ODE::ODE)
      set(libraries ODE::ODE)
    endif()
  endif()
endmacro()

# <double>: whether Bullet is wanted in double precision. Only its three libraries for rigid bodies are
# linked, though bullet.pc and BULLET_LIBRARIES list soft bodies and others as well.
macro(_ductile_find_bullet double)
  if(${double})
    _ductile_ask_pkg_config(DUCTILE_PC_BULLET_FLOAT64 bullet-float64)
  else()
    _ductile_ask_pkg_config(DUCTILE_PC_BULLET bullet)
    if(definitions MATCHES "BT_USE_DOUBLE_PRECISION")
      set(libraries "")
    endif()
  endif()
  list(FILTER libraries INCLUDE REGEX "(BulletDynamics|BulletCollision|LinearMath)[^/]*$")
  if(NOT libraries)
    _ductile_find_bullet_package(${double})
  endif()
endmacro()

macro(_ductile_find_bullet_package double)
  set(includes "")
  set(definitions "")
  # Debian's configuration for double precision lies beside the one for single
  set(configurations BulletConfig.cmake bullet-config.cmake)
  if(${double})
    list(PREPEND configurations BulletConfig-float64.cmake)
  endif()
  find_package(Bullet QUIET CONFIG CONFIGS ${configurations})
  set(is_double OFF)
  if("${BULLET_DEFINITIONS}" MATCHES "BT_USE_DOUBLE_PRECISION")
    set(is_double ON)
  endif()
  if(Bullet_FOUND AND TARGET Bullet::Bullet AND is_double STREQUAL "${double}") # Conan's
    set(libraries Bullet::Bullet)
  elseif(Bullet_FOUND AND is_double STREQUAL "${double}")
    set(names ${BULLET_LIBRARIES})
    list(FILTER names INCLUDE REGEX "(BulletDynamics|BulletCollision|LinearMath)[^/]*$")
    list(REVERSE names) # Bullet lists what is needed before what needs it
    foreach(name IN LISTS names)
      if(TARGET ${name} OR EXISTS "${name}")
        list(APPEND libraries ${name})
        continue()
      endif()
      find_library(DUCTILE_BULLET_${name} ${name}
        HINTS ${BULLET_LIBRARY_DIRS} ${BULLET_ROOT_DIR}/${BULLET_LIBRARY_DIRS})
      mark_as_advanced(DUCTILE_BULLET_${name})
      if(NOT DUCTILE_BULLET_${name})
        set(libraries "")
        break()
      endif()
      list(APPEND libraries ${DUCTILE_BULLET_${name}})
    endforeach()
    foreach(folder IN LISTS BULLET_INCLUDE_DIRS)
      if(NOT IS_ABSOLUTE "${folder}")
        string(PREPEND folder "${BULLET_ROOT_DIR}/")
      endif()
      list(APPEND includes "${folder}")
    endforeach()
  endif()
endmacro()
