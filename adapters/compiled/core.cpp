// SPDX-License-Identifier: MIT
//
// What of the core is compiled once (DUCTILE_COMPILED).
#include <ductile/ductile.hpp>
