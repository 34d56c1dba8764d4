// SPDX-License-Identifier: MIT
//
// The front door of the ODE adapter. Link ductile::ode.
#pragma once

#include "ductile/ductile.hpp"
#include "ductile/ode/energy.hpp"
#include "ductile/ode/one_axis_constraint.hpp"
#include "ductile/ode/plastic_hinge.hpp"
#include "ductile/ode/plastic_slider.hpp"
#include "ductile/ode/world.hpp"
