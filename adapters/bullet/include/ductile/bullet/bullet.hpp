// SPDX-License-Identifier: MIT
//
// The front door of the Bullet adapter. Link ductile::bullet (float) or ductile::bullet_float64.
#pragma once

#include "ductile/bullet/energy.hpp"
#include "ductile/bullet/one_axis_constraint.hpp"
#include "ductile/bullet/plastic_hinge.hpp"
#include "ductile/bullet/plastic_slider.hpp"
#include "ductile/ductile.hpp"
