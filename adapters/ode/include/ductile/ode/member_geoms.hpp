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

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "ductile/member/divided_member.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/piece.hpp"
#include "ductile/ode/world_snapshot.hpp"

namespace ductile::ode {

class MemberGeoms {
  public:
    /// `whole`, which is straight, is at `in_body` in the user's body.
    /// @throws std::invalid_argument where there is no box, and one geom as long as the member.
    MemberGeoms(dBodyID user, const ductile::Member& member, const MemberBox& box,
                const MemberPiece& whole, const JointFrame<double>& in_body)
        : user_(user), member_(member), box_(box), boxes_(std::size_t(member.segments()), nullptr) {
        for (dGeomID geom = dBodyGetFirstGeom(user); geom != nullptr;
             geom = dBodyGetNextGeom(geom)) {
            Geom& entry = users_.emplace_back();
            entry.geom = geom;
            entry.in_body = {to_core(dGeomGetOffsetPosition(geom)),
                             matrix_to_core(dGeomGetOffsetRotation(geom))};
            entry.segment = nearest_segment(member, whole, in_body, entry.in_body.origin);
            const JointFrame<double> segment = placed(in_body, whole.segment(entry.segment));
            entry.in_segment = {
                transposed_times(segment.axes, difference(entry.in_body.origin, segment.origin)),
                transposed_times(segment.axes, entry.in_body.axes)};
        }
        find_overhang(placed(in_body, whole.section(member, 0, false)));
    }
    MemberGeoms(const MemberGeoms&) = delete;
    MemberGeoms& operator=(const MemberGeoms&) = delete;

    /// The user's body has them as at first.
    void put_straight() {
        for (Geom& entry : users_) {
            detail::put_on(entry.geom, user_, entry.in_body);
            if (box_.is_there() && boxes_.back() != nullptr && entry.enabled) {
                dGeomEnable(entry.geom);
            }
        }
        destroy_boxes();
    }
    /// A piece is at `in_body` in `body`. Has to be called of all pieces of an open or bent member.
    void put(const MemberPiece& piece, dBodyID body, const JointFrame<double>& in_body) {
        if (box_.is_there()) {
            make_boxes();
            for (int k = piece.run.first; k <= piece.run.last; ++k) {
                if (boxes_[std::size_t(k)] == nullptr) continue;
                dGeomDisable(boxes_[std::size_t(k)]);
                dGeomSetBody(boxes_[std::size_t(k)], nullptr);
            }
            for (const StraightStretch& stretch : straight_stretches(member_, piece, over_)) {
                const dGeomID of_it = boxes_[std::size_t(stretch.run.first)];
                if (of_it == nullptr) continue;
                dGeomBoxSetLengths(of_it, dReal(2 * box_.half_width), dReal(2 * box_.half_height),
                                   dReal(stretch.length));
                dGeomEnable(of_it);
                detail::put_on(of_it, body, placed(in_body, stretch.middle));
            }
            return;
        }
        for (const Geom& entry : users_) {
            if (!piece.run.holds(entry.segment)) continue;
            detail::put_on(entry.geom, body,
                           placed(placed(in_body, piece.segment(entry.segment)), entry.in_segment));
        }
    }

  private:
    struct Geom {
        dGeomID geom;
        int segment;
        JointFrame<double> in_segment;
        JointFrame<double> in_body; ///< of the user's body, at first
        bool enabled = true;
    };

    /// Looked for where the member is along z of the world from the origin on.
    void find_overhang(const JointFrame<double>& start_in_body) {
        constexpr double as_long = 0.9; // as the member
        double low = 0, high = 0, longest = 0;
        const BodySnapshot pose(user_);
        const JointFrame<double> body = frame_around({}, start_in_body);
        dMatrix3 turned;
        detail::to_ode(body.axes, turned);
        dBodySetRotation(user_, turned);
        dBodySetPosition(user_, dReal(body.origin.x()), dReal(body.origin.y()),
                         dReal(body.origin.z()));
        for (const Geom& entry : users_) {
            std::array<dReal, 6> bounds{};
            dGeomGetAABB(entry.geom, bounds.data());
            low = std::min(low, double(bounds[4]));
            high = std::max(high, double(bounds[5]));
            longest = std::max(longest, double(bounds[5] - bounds[4]));
        }
        pose.put_pose_back(user_);
        if (!box_.is_there() && longest > as_long * member_.length()) {
            throw std::invalid_argument(
                "Member.box: must be given where one geom of its body is as long as the member, as "
                "it would go with one segment");
        }
        over_ = MemberOverhang::of(member_, low, high);
    }
    void make_boxes() {
        if (users_.empty()) return;
        if (boxes_.back() == nullptr) {
            for (Geom& entry : users_) {
                entry.enabled = dGeomIsEnabled(entry.geom) != 0;
                dGeomDisable(entry.geom);
            }
        }
        const dGeomID like = users_.front().geom;
        for (int k = 0; k < member_.segments(); ++k) {
            dGeomID& box = boxes_[std::size_t(k)];
            if (box != nullptr || member_.segment(k).held) continue;
            box = dCreateBox(dGeomGetSpace(like), dReal(2 * box_.half_width),
                             dReal(2 * box_.half_height), dReal(member_.segment(k).length));
            dGeomSetData(box, dGeomGetData(like));
            dGeomSetCategoryBits(box, dGeomGetCategoryBits(like));
            dGeomSetCollideBits(box, dGeomGetCollideBits(like));
        }
    }
    void destroy_boxes() {
        for (dGeomID& box : boxes_) {
            if (box != nullptr) dGeomDestroy(box);
            box = nullptr;
        }
    }

    dBodyID user_;
    const ductile::Member& member_;
    MemberBox box_;
    MemberOverhang over_; ///< of the user's geoms
    std::vector<Geom> users_;
    std::vector<dGeomID> boxes_; ///< by segment; null: none; disabled: another's is as long
};

} // namespace ductile::ode
