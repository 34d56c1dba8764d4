// SPDX-License-Identifier: MIT
//
// Where the joints of a member sit, and of how much of its length each one is the flexibility.
//
// A chain of rigid pieces with a joint of k = E I/l_i at the station x_i turns under the moments
// M(x) by Σ M(x_i) m(x_i) l_i/(E I) where the elastic member turns by ∫ M m dx/(E I), m the moment
// of a unit load: the stations and lengths are a quadrature rule. With those of Gauss a few pieces
// have the stiffness of the elastic member. An end that is jointed is a station, so the rule is
//
//   ends jointed        rule       exact to degree   pieces for end forces (2), uniform load (3)
//   none                Legendre   2n - 1            3, 3
//   one                 Radau      2n - 2            2, 3
//   both                Lobatto    2n - 3            2, 2          (Simpson's: 1/6, 2/3, 1/6)
//
// for n stations. Lengths add up to that of the member, so stretch, twist and bending by a constant
// moment are right with any. `equal`: pieces of one length; a joint stands for the halves of the
// pieces beside it, and for all of a last piece whose far end has no joint.
//
// Source: M. H. Scott, G. L. Fenves (2006), Plastic hinge integration methods for force-based
// beam-column elements, J. Struct. Eng. 132(2), 244-252; Abramowitz and Stegun (1964), 25.4.
#pragma once

#include <vector>

#include "ductile/vocabulary/linkage.hpp"

namespace ductile {

enum class JointSpacing {
    gauss, ///< few pieces as stiff as the elastic member
    equal  ///< pieces of one length
};

/// One joint of a member.
struct JointStation {
    double at = 0;    ///< from the member's start, as a share of its length, in [0, 1]
    double share = 0; ///< of the member's length that it stands for, > 0

    bool operator==(const JointStation&) const = default;
};

/// In order along a member of `pieces` >= 1 rigid pieces: pieces - 1, and one more at every jointed
/// end. Cost O(pieces²).
[[nodiscard]] std::vector<JointStation> joint_stations(int pieces, bool start_jointed,
                                                       bool end_jointed, JointSpacing spacing);

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/structure/joint_stations.ipp"
#endif
