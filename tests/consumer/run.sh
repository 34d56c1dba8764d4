#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Builds and runs a small consumer by every way in which one can get this library, and looks whether
# wrong builds are refused in words.
#   tests/consumer/run.sh SOURCE_DIR BUILD_DIR PART [ADAPTER ...]
# BUILD_DIR is a finished build of SOURCE_DIR: what it installs is what is tried. PART is what is tried: an
# adapter, or core, which is that and all that is refused. An adapter is bullet, bullet_float64 or ode: those
# whose engine is here. CXX and CXXFLAGS choose the compiler and its flags.
set -euo pipefail
source=$(realpath "$1") build=$(realpath "$2") part=$3
shift 3
adapters=" $* "
here=$source/tests/consumer
work=$build/consumer/$part
prefix=$work/prefix
rm -rf "$work"
mkdir -p "$work"
cd "$work"
read -ra cxx <<<"${CXX:-c++} -std=c++20 ${CXXFLAGS:-}"
export CXX=${CXX:-c++} CXXFLAGS=${CXXFLAGS:-}
export PKG_CONFIG_PATH=$prefix/share/pkgconfig:$prefix/lib/pkgconfig:${PKG_CONFIG_PATH:-}
failures=0

# step NAME EXPECTED COMMAND...: runs the command; one line of what it says must be EXPECTED's, a regular
# expression. A command that is to be refused is given as `refused COMMAND...`.
step() {
    local name=$1 expected=$2 start=$SECONDS verdict=ok
    shift 2
    "$@" >log 2>&1 || verdict=FAILED
    grep -qE -- "$expected" log || verdict=FAILED
    printf '%-6s %3d s  %s\n' "$verdict" $((SECONDS - start)) "$name"
    if [ $verdict = FAILED ]; then
        echo "  expected: $expected"
        sed 's/^/  | /' log
        failures=$((failures + 1))
    fi
}
refused() { ! "$@"; }
has() { [[ $adapters == *" $1 "* ]]; }
tries() { [[ $part == "$1" ]]; }

# consume PROGRAM OPTIONS...: configures, builds and runs the CMake project here
consume() {
    local program=$1
    shift
    rm -rf project
    cmake -S "$here" -B project -DPROGRAM="$program" "$@" && cmake --build project -j 2 && ./project/consumer
}
# compile PROGRAM FLAGS...: compiles and runs
compile() {
    local program=$1
    shift
    rm -f program
    "${cxx[@]}" "$program" "$@" -o program && ./program
}
package() { pkg-config --cflags --libs "$1" | tr '\n' ' '; }

cmake --install "$build" --prefix "$prefix" >install.log

# ---- every way to get it ------------------------------------------------------------------------------
holds='^holds 64\.0 N m$'
tries core && step "add_subdirectory, core" "$holds" consume "$here/core.cpp" \
    -DWAY=add_subdirectory -DDUCTILE="$source" -DTARGET=ductile::ductile
for adapter in bullet bullet_float64 ode; do
    tries $adapter && step "add_subdirectory, $adapter" "$holds" consume "$here/${adapter%_float64}.cpp" \
        -DWAY=add_subdirectory -DDUCTILE="$source" -DTARGET=ductile::$adapter
done

if tries core; then
    tar -czf ductile.tar.gz -C "$source" CMakeLists.txt LICENSE cmake include adapters
    step "FetchContent, core" "$holds" consume "$here/core.cpp" \
        -DWAY=FetchContent -DDUCTILE="file://$work/ductile.tar.gz" -DTARGET=ductile::ductile
fi

# find_component COMPONENTS PROGRAM OPTIONS...: find_package; none: the core alone
find_component() {
    consume "$2" -DCMAKE_PREFIX_PATH="$prefix" -DCOMPONENTS="$1" \
        -DTARGET="ductile::${1:-ductile}" "${@:3}"
}
tries core && step "find_package, core" "$holds" find_component "" "$here/core.cpp" -DHEADER=ductile/ductile.hpp
for adapter in bullet bullet_float64; do
    tries $adapter && step "find_package, $adapter" '^took 96\.0 J over 1\.50 rad$' \
        find_component $adapter "$here/bullet_hinge.cpp" -DHEADER=ductile/bullet/bullet.hpp
done
tries ode && step "find_package, ode" '^took 96\.000 J over 1\.500 rad' \
    find_component ode "$source/examples/first/first.cpp" -DHEADER=ductile/ode/ode.hpp

if [ -e "$prefix/lib/libductile.a" ]; then
    tries core && step "find_package, compiled" "$holds" find_component compiled "$here/core.cpp"
    for adapter in bullet bullet_float64; do
        tries $adapter && step "find_package, ${adapter}_compiled" '^took 96\.0 J over 1\.50 rad$' \
            find_component ${adapter}_compiled "$here/bullet_hinge.cpp" \
            -DHEADER=ductile/bullet/bullet.hpp
    done
    tries ode && step "find_package, ode_compiled" '^took 96\.000 J over 1\.500 rad' \
        find_component ode_compiled "$source/examples/first/first.cpp" -DHEADER=ductile/ode/ode.hpp
elif tries core; then
    step "compiled, where there is none" 'component compiled: not installed, build ductile with' \
        refused find_component compiled "$here/core.cpp"
fi

tries core && step "pkg-config, core" "$holds" compile "$here/core.cpp" $(package ductile)
for adapter in bullet bullet_float64 ode; do
    tries $adapter && step "pkg-config, $adapter" "$holds" \
        compile "$here/${adapter%_float64}.cpp" $(package "ductile-${adapter/_/-}")
done

eigen=$(pkg-config --cflags eigen3)
core="-I$source/include $eigen"
bullet="$core -I$source/adapters/bullet/include -isystem /usr/include/bullet"
ode="$core -I$source/adapters/ode/include"
# bullet_libraries SUFFIX
bullet_libraries() { echo "-lBulletDynamics$1 -lBulletCollision$1 -lLinearMath$1"; }
tries core && step "include path, core" "$holds" compile "$here/core.cpp" $core
tries bullet && step "include path, bullet" "$holds" \
    compile "$here/bullet.cpp" $bullet $(bullet_libraries "")
tries bullet_float64 && step "include path, bullet_float64" "$holds" \
    compile "$here/bullet.cpp" -DBT_USE_DOUBLE_PRECISION $bullet $(bullet_libraries -float64)
tries ode && step "include path, ode" "$holds" compile "$here/ode.cpp" $ode -lode

# ---- engines that pkg-config does not know --------------------------------------------------------------
for adapter in bullet bullet_float64; do
    tries $adapter && PKG_CONFIG_LIBDIR=/nonexistent PKG_CONFIG_PATH='' \
        step "Bullet's CMake package, $adapter" "$holds" \
        find_component $adapter "$here/bullet.cpp"
done
tries bullet && step "a target of one's own" "$holds" \
    find_component bullet "$here/bullet.cpp" -DDUCTILE_BULLET_TARGET=own_bullet \
    -DOWN_BULLET="BulletDynamics;BulletCollision;LinearMath" -DOWN_BULLET_INCLUDE=/usr/include/bullet
tries core && step "an optional component that is none" "$holds" find_component "" "$here/core.cpp" -DOPTIONAL=havok

# ---- what is refused, and in which words -----------------------------------------------------------------
refusals() {
    step "unknown component" '^ *ductile: component havok: no such component .there are bullet,' \
        refused find_component havok "$here/core.cpp"
    for engine in Bullet ode; do
        adapter=${engine,}
        PKG_CONFIG_LIBDIR=/nonexistent PKG_CONFIG_PATH='' \
            step "no $engine" "^ *ductile: component $adapter: .* not found, and DUCTILE_.*_TARGET names no target of yours" \
            refused find_component $adapter "$here/$adapter.cpp" -DCMAKE_DISABLE_FIND_PACKAGE_$engine=TRUE
    done
    step "a target that is none" 'component bullet: DUCTILE_BULLET_TARGET names nobody, which is not a' \
        refused find_component bullet "$here/bullet.cpp" -DDUCTILE_BULLET_TARGET=nobody
    has bullet && has bullet_float64 && step "both precisions in one program" \
        'INTERFACE_DUCTILE_BULLET_PRECISION' refused find_component "bullet;bullet_float64" \
        "$here/bullet.cpp" -DTARGET="ductile::bullet;ductile::bullet_float64"
    for flag in -ffast-math -ffinite-math-only; do
        step "$flag" "ductile: $flag .*removes the checks" refused compile "$here/core.cpp" $core $flag -Wfatal-errors
    done
    if has bullet && has bullet_float64; then
        step "single precision with the macro of double" 'ductile::bullet with BT_USE_DOUBLE_PRECISION' \
            refused compile "$here/bullet.cpp" -DBT_USE_DOUBLE_PRECISION $(package ductile-bullet)
        step "compiled for single, linked with double" 'link_with_Bullet_built_for_single_precision' \
            refused compile "$here/bullet.cpp" $bullet $(bullet_libraries -float64)
        step "compiled for double, linked with single" 'link_with_Bullet_built_for_double_precision' \
            refused compile "$here/bullet.cpp" -DBT_USE_DOUBLE_PRECISION $bullet $(bullet_libraries "")
        step "linked with both, the wrong one first" \
            'ductile: compiled for Bullet in single precision, but the Bullet library in this' \
            refused compile "$here/bullet.cpp" $bullet $(bullet_libraries -float64) $(bullet_libraries "")
        archive=$prefix/lib/libductile-bullet-float64.a
        [ -e "$archive" ] && step "the compiled library of the other precision" \
            'link_with_ductile_compiled_for_single_precision' refused \
            compile "$here/bullet.cpp" -DDUCTILE_COMPILED $bullet "$archive" $(bullet_libraries "")
    fi
    has ode && step "ODE in double, compiled for single" \
        'ductile: compiled for ODE in single precision .dIDESINGLE., but' \
        refused compile "$here/ode.cpp" $ode -DdIDESINGLE -lode
}
tries core && refusals

if [ $failures -gt 0 ]; then
    echo "$failures ways failed"
    exit 1
fi
