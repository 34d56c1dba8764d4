// SPDX-License-Identifier: MIT
//
// Refuses a program whose Bullet library was built for another precision than its headers are read
// in. btScalar is float, or double where BT_USE_DOUBLE_PRECISION is defined, and nothing in Bullet
// notices when the two differ: bodies have another size on either side of a call, and memory is
// overwritten.
//
// Where it is noticed, in the order of a build:
//   compiler  the CMake target or .pc file of one precision, the macro of the other: #error
//   linker    the library has no function that takes our btScalar: the function that misses it is
//             named after what to do,
//             "in function `...link_with_Bullet_built_for_double_precision...'"
//   run time  both builds of the library are in the program, or another one was loaded than was
//             linked: `require_matching_precision` throws
#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <stdexcept>

#ifdef DUCTILE_BULLET_DOUBLE
#if DUCTILE_BULLET_DOUBLE && !defined(BT_USE_DOUBLE_PRECISION)
#error \
    "ductile: ductile::bullet_float64 without BT_USE_DOUBLE_PRECISION; link ductile::bullet for single precision"
#elif !DUCTILE_BULLET_DOUBLE && defined(BT_USE_DOUBLE_PRECISION)
#error \
    "ductile: ductile::bullet with BT_USE_DOUBLE_PRECISION; link ductile::bullet_float64 for double precision"
#endif
#endif

namespace ductile::bullet {

#ifdef DUCTILE_COMPILED
/// Defined in the compiled library of this adapter, once for each precision.
#ifdef BT_USE_DOUBLE_PRECISION
void link_with_ductile_compiled_for_double_precision();
#else
void link_with_ductile_compiled_for_single_precision();
#endif
#endif

namespace detail {

/// Sets the damping to zero, by a function that only a library of our precision has.
#ifdef BT_USE_DOUBLE_PRECISION
inline void link_with_Bullet_built_for_double_precision(btRigidBody& body) {
#else
inline void link_with_Bullet_built_for_single_precision(btRigidBody& body) {
#endif
    body.setDamping(btScalar(0), btScalar(0));
#ifdef DUCTILE_COMPILED
#ifdef BT_USE_DOUBLE_PRECISION
    link_with_ductile_compiled_for_double_precision();
#else
    link_with_ductile_compiled_for_single_precision();
#endif
#endif
}

inline bool check_precision() {
    // Bullet's own fixed body: made by the library, so it has the library's layout, and asked by a
    // function that the library compiled. Both are called alike in both precisions.
    btRigidBody& fixed = btTypedConstraint::getFixedBody();
    constexpr int ours = int(sizeof(btRigidBodyData));
    if (fixed.btRigidBody::calculateSerializeBufferSize() != ours) {
        throw std::logic_error(
            sizeof(btScalar) == sizeof(double)
                ? "ductile: compiled for Bullet in double precision (BT_USE_DOUBLE_PRECISION), but "
                  "the Bullet library in this program is built for single precision"
                : "ductile: compiled for Bullet in single precision, but the Bullet library in "
                  "this program is built for double precision; define BT_USE_DOUBLE_PRECISION");
    }
    // called through a pointer that the compiler cannot see through, so that the linker's complaint
    // names the function and not whatever it would be inlined into
    void (*volatile link)(btRigidBody&) =
#ifdef BT_USE_DOUBLE_PRECISION
        &link_with_Bullet_built_for_double_precision;
#else
        &link_with_Bullet_built_for_single_precision;
#endif
    link(fixed);
    return true;
}

} // namespace detail

/// What World and every constraint of this adapter call first. Looks once per process; a later call
/// costs the test of one static. Thread-safe against itself; the first call writes to
/// btTypedConstraint::getFixedBody(), so it does not belong beside a step of another thread.
/// @throws std::logic_error where the library in the program is of the other precision.
inline void require_matching_precision() {
    [[maybe_unused]] static const bool checked = detail::check_precision();
}

} // namespace ductile::bullet
