// SPDX-License-Identifier: MIT
//
// The geoms of a member's body while that is one body or several. ODE lets a geom change its body,
// so the user's own go with the segments, and keep ids, data, bits and spaces:
//
//   no box   each geom of the body belongs to the segment nearest to its middle, and goes with it
//   a box    they are the member's while it is whole and straight, and disabled while it is open or
//            bent; then each stretch without a bend has a box, that of its first segment, made in
//            the space of the first of them, with its data and bits; those at the ends reach as
//            far as the user's geoms. For one long geom in place of one per segment.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "ductile/member/divided_member.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class MemberGeoms {
  public:
    /// `whole`, which is straight, is at `in_body` in the user's body.
    /// @throws std::invalid_argument where there is no box, and one geom as long as the member.
    MemberGeoms(dBodyID user, const ductile::Member& member, const MemberBox& box,
                const MemberPiece& whole, const JointFrame<double>& in_body);
    MemberGeoms(const MemberGeoms&) = delete;
    MemberGeoms& operator=(const MemberGeoms&) = delete;

    /// The user's body has them as at first.
    void put_straight();
    /// A piece is at `in_body` in `body`. Has to be called of all pieces of an open or bent member.
    void put(const MemberPiece& piece, dBodyID body, const JointFrame<double>& in_body);

  private:
    struct Geom {
        dGeomID geom;
        int segment;
        JointFrame<double> in_segment;
        JointFrame<double> in_body; ///< of the user's body, at first
        bool enabled = true;
    };

    void find_overhang(const JointFrame<double>& start_in_body);
    void make_boxes();
    void destroy_boxes();

    dBodyID user_;
    const ductile::Member& member_;
    MemberBox box_;
    MemberOverhang over_; ///< of the user's geoms
    std::vector<Geom> users_;
    std::vector<dGeomID> boxes_; ///< by segment; null: none; disabled: another's is as long
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/member_geoms.ipp"
#endif
