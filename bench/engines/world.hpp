// SPDX-License-Identifier: MIT
//
// The engine that this program is built for.
#pragma once

#ifdef BENCH_ODE
#include "engines/ode_world.hpp"
#else
#include "engines/bullet_world.hpp"
#endif

namespace bench {

#ifdef BENCH_ODE
using World = OdeWorld;
#else
using World = BulletWorld;
#endif

} // namespace bench
