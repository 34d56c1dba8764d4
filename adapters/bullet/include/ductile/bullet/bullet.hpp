// SPDX-License-Identifier: MIT
//
// The front door of the Bullet adapter. Link ductile::bullet (float) or ductile::bullet_float64.
#pragma once

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/draw.hpp"
#include "ductile/bullet/driven_ways.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/front_solver.hpp"
#include "ductile/bullet/half_ahead.hpp"
#include "ductile/bullet/island_rows.hpp"
#include "ductile/bullet/island_solver.hpp"
#include "ductile/bullet/joint_constraint.hpp"
#include "ductile/bullet/multibody_ball.hpp"
#include "ductile/bullet/multibody_constraint.hpp"
#include "ductile/bullet/multibody_energy.hpp"
#include "ductile/bullet/multibody_hinge.hpp"
#include "ductile/bullet/multibody_solver.hpp"
#include "ductile/bullet/plastic_constraint.hpp"
#include "ductile/bullet/plastic_hinge.hpp"
#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/bullet/plastic_motor.hpp"
#include "ductile/bullet/plastic_slider.hpp"
#include "ductile/bullet/touching_islands.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/bullet/world_parts.hpp"
#include "ductile/bullet/world_snapshot.hpp"
#include "ductile/ductile.hpp"
