// SPDX-License-Identifier: MIT
//
// Refuses a program whose ODE library was built for another precision than its headers are read in.
// dReal is double, or float where dIDESINGLE (or dSINGLE) is defined, and ODE's C functions are
// called alike in both: a call would pass garbage. The library itself says what it is.
#pragma once

#include <ode/common.h>

#include <stdexcept>

namespace ductile::ode {

/// What World and every joint of this adapter call first. Looks once per process; a later call
/// costs the test of one static. Thread-safe; ODE need not be initialised.
/// @throws std::logic_error where the library in the program is of the other precision.
inline void require_matching_precision() {
    [[maybe_unused]] static const bool checked = [] {
        const bool library = dCheckConfiguration("ODE_double_precision") != 0;
        constexpr bool ours = sizeof(dReal) == sizeof(double);
        if (library && !ours) {
            throw std::logic_error(
                "ductile: compiled for ODE in single precision (dIDESINGLE), but the ODE library "
                "in "
                "this program is built for double precision");
        }
        if (!library && ours) {
            throw std::logic_error(
                "ductile: compiled for ODE in double precision, but the ODE library in this "
                "program "
                "is built for single precision; define dIDESINGLE");
        }
        return true;
    }();
}

} // namespace ductile::ode
