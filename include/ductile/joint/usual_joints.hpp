// SPDX-License-Identifier: MIT
//
// The joints that most scenes are made of, by name, and compiled once where DUCTILE_COMPILED is
// defined: who uses them then compiles none of their functions. Any other joint is compiled where
// it is used.
#pragma once

#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/any_link.hpp"
#include "ductile/joint/axis_joint.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"

namespace ductile {

/// A hinge or bar of constant strength that breaks when its plastic travel is used up.
using UsualAxisJoint = OneAxisJoint<Perfect<double>, TravelLimit<double>>;
/// Six axes that share an ellipsoid of constant size: section_joint.
using UsualSixAxisJoint = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>, TravelLimit<double>>;

#ifdef DUCTILE_COMPILED
extern template class Ellipsoid<double, 6>;
extern template class OneAxisJoint<Perfect<double>, TravelLimit<double>>;
extern template class CoupledJoint<Ellipsoid<double, 6>, Perfect<double>, TravelLimit<double>>;
extern template class AnyLink<double>;
extern template class Link<UsualAxisJoint>;
extern template class Link<UsualSixAxisJoint>;
extern template class AxisJointOf<UsualAxisJoint>;
#endif

} // namespace ductile
