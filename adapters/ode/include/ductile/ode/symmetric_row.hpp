// SPDX-License-Identifier: MIT
//
// The row of the core as a motor of ODE: FMax = strength, Vel = velocity, CFM = cfm.
#pragma once

#include "ductile/vocabulary/symmetric_row.hpp"

namespace ductile::ode {

using ductile::symmetric_row, ductile::SymmetricRow;

} // namespace ductile::ode
