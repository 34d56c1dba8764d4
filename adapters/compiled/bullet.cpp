// SPDX-License-Identifier: MIT
//
// What of the adapter for Bullet is compiled once (DUCTILE_COMPILED), in either precision.
#include <ductile/bullet/bullet.hpp>
