// SPDX-License-Identifier: MIT
//
// The front door: the whole core, engine-free. Adapters for engines are separate headers,
// ductile/bullet/bullet.hpp and ductile/ode/ode.hpp.
#pragma once

#include "ductile/detail/step_control.hpp"
#include "ductile/energy.hpp"
#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/pair.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/material.hpp"
#include "ductile/section/circle.hpp"
#include "ductile/section/notched_rectangle.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/vocabulary/angle.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/row.hpp"
