// SPDX-License-Identifier: MIT
//
// The front door of the Bullet adapter: joints and the World that steps them. Members and
// structures are other doors: members.hpp, structure.hpp, structure_in_time.hpp. Link
// ductile::bullet (float) or ductile::bullet_float64.
#pragma once

#include "ductile/bullet/draw.hpp"
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
#include "ductile/bullet/world.hpp"
#include "ductile/ductile.hpp"
