// SPDX-License-Identifier: MIT
//
// What of the adapter for ODE is compiled once (DUCTILE_COMPILED).
#include <ductile/ode/ode.hpp>
