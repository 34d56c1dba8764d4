// SPDX-License-Identifier: MIT
//
// A member in ODE: the user's rigid body as long as all its sections hold, several bodies while
// some flow, the user's body again, bent, when the flow has stopped.
//
//   ductile::ode::World world(id, {.tolerance = 0.01});
//   const auto beam = ductile::beam(section, steel, {.length = 2, .clamped = true});
//   ductile::ode::Member post(body, beam, start_in_body);   // a geom per segment on the body
//   world.add(post, "lamp post");
//
// The body. It is the member while that is whole, with its own mass and inertia; of a clamped
// member it is kinematic, and the part that is held stays on it. While one that moves is open its
// body is in no World, disabled, with no geoms and joints; it is never destroyed, and in the World
// again where all sections hold: as it was where none is bent, else with the mass of bent segments.
// Its damping, sleep, gravity mode, modes of turning and data are also those of the pieces; a moved
// callback is not, as ODE does not tell it. `of` finds the member of a body in a contact callback.
// Bodies of pieces end when sections open and close: keep no address of one.
//
// What holds on to it. Geoms go along (member_geoms.hpp). So do the user's joints, anchors, axes
// and angle as they are: balls and hinges by their anchor, what has none by `attach`; joints of
// other kinds are refused. Contacts have to be named, and go to the body that has the segment;
// those of two pieces that hang together are none. Forces: apply_force, as a body's own loses the
// point where it acted.
//
// Where it ends while it is open it is one body first, bent as it is.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <span>
#include <vector>

#include "ductile/joint/usual_joints.hpp"
#include "ductile/member/stepped_member.hpp"
#include "ductile/ode/divisible.hpp"
#include "ductile/ode/member_geoms.hpp"
#include "ductile/ode/piece.hpp"
#include "ductile/ode/plastic_hinge.hpp"
#include "ductile/ode/user_joint.hpp"
#include "ductile/ode/world_life.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

using ductile::MemberBox;

/// A section that flows, or did.
struct OpenSection {
    int section;
    std::unique_ptr<PlasticHinge<UsualAxisJoint>> hinge;
};

/// By what a joint holds a member.
struct HeldBy {
    bool holds = false;                             ///< it cannot move, but along
    Vector3<double> rail = Vector3<double>::Zero(); ///< of length 1; zero: not at all
};

/// A joint of the user's, and by what it holds.
struct MemberHold : UserJoint {
    HeldBy support{};
};

struct MemberBody {
    dBodyID body = nullptr;
    MemberRun run{};
    bool own = false; ///< else the user's
};

/// As member/stepped_member.hpp wants it.
struct MemberParts {
    using Divisible = ode::Divisible;
    using Joint = PlasticConstraint;
    using OpenSection = ode::OpenSection;
    using Piece = MemberBody;
    using Hold = MemberHold;
};

/// What it says of its sections: member/divided_member.hpp. All of it: member_snapshot.hpp.
class Member final : public SteppedMember<MemberParts> {
  public:
    /// `start_in_body`: the member's frame in the frame of the body's centre of mass.
    /// @throws std::invalid_argument where the body is null, is kinematic and the member not
    /// clamped or the other way round, has another mass than the member, its centre elsewhere, or
    /// is a member already, or a frame is none; or as MemberGeoms.
    Member(dBodyID body, ductile::Member member, const JointFrame<double>& start_in_body,
           const MemberBox& box = {});
    DUCTILE_INLINE ~Member() override;

    /// Null for a body that belongs to no member.
    [[nodiscard]] static Member* of(dBodyID body);

    /// Bodies that it is now, from its start, but for the user's where that has nothing but the
    /// held end.
    [[nodiscard]] std::vector<dBodyID> pieces() const;
    /// The body that has a segment now.
    [[nodiscard]] DUCTILE_INLINE dBodyID body_of(int segment) const override;
    /// Middle of a segment, axes of the member: what to draw.
    [[nodiscard]] JointFrame<double> pose(int segment) const;

    /// A joint of the body holds at `place` [m] along the member. To be called for one that has no
    /// anchor before it is added to a World.
    /// @throws std::invalid_argument where the place is beyond the ends or the joint null.
    void attach(double place, dJointID joint);
    /// `force` [N] at `place` [m] along the member, world axes, for the next step.
    /// @throws std::invalid_argument where the place is beyond the ends or the force not finite.
    void apply_force(const Vector3<double>& force, double place);

  private:
    friend class MemberSnapshot;
    // ---- what SteppedMember asks

    [[nodiscard]] DUCTILE_INLINE JointFrame<double> frame_of(std::size_t piece) const override;
    [[nodiscard]] DUCTILE_INLINE BodyMotion motion_of(std::size_t piece) const override;
    [[nodiscard]] DUCTILE_INLINE Vector3<double> momentum() const override;
    [[nodiscard]] DUCTILE_INLINE Vector3<double> point_of(const MemberPlace& at) const override;
    DUCTILE_INLINE void become(const std::vector<PlacedPiece>& pieces, bool ahead) override;
    [[nodiscard]] DUCTILE_INLINE OpenSection
    make_joint(std::size_t lower, const JointFrame<double>& in_lower,
               const JointFrame<double>& in_upper) override;
    DUCTILE_INLINE void enter_joint(OpenSection& open, bool ahead) override;
    DUCTILE_INLINE void add_force(int segment, const Vector3<double>& force,
                                  const Vector3<double>& at) override;

    // ---- what the World asks

    DUCTILE_INLINE void enter(World& world) override;
    DUCTILE_INLINE void leave() override;
    void body_left(dBodyID body) override { is_missing_ = is_missing_ || body == user_; }
    void body_came(dBodyID body) override { is_missing_ = is_missing_ && body != user_; }
    [[nodiscard]] DUCTILE_INLINE std::vector<dBodyID> bodies() const override;
    [[nodiscard]] std::vector<DivisionReport> reports(const std::string& name) const override {
        return {{static_cast<const Divisible*>(this), name, [this] { return report(); }}};
    }
    [[nodiscard]] DUCTILE_INLINE bool hangs_together(dBodyID a, dBodyID b) const override;
    [[nodiscard]] DUCTILE_INLINE bool holds(dBodyID own, dBodyID other) const override;
    DUCTILE_INLINE void require_possible() override;
    DUCTILE_INLINE void before_solve(std::vector<dJointID>& joints) override;
    DUCTILE_INLINE void after_solve() override;
    DUCTILE_INLINE void find_beyond(double dt, std::span<Touch> touches,
                                    std::vector<int>& sections) override;
    DUCTILE_INLINE void find_struck(double dt, std::span<Touch> touches,
                                    std::vector<int>& sections) override;

    // ---- bodies

    [[nodiscard]] const MemberBody& piece_on(dBodyID body) const;
    [[nodiscard]] JointFrame<double> in_body(std::size_t piece) const;
    [[nodiscard]] MemberBody make_body(const PlacedPiece& placed);
    void take_out();
    void put_whole(const PlacedPiece& placed);
    void put_geoms();
    void find_holds();
    [[nodiscard]] MemberPlace place_of(dJointID joint, std::size_t piece) const;

    // ---- a step

    [[nodiscard]] double sum_of_impulses(double dt, std::span<const Touch> touches) const;
    [[nodiscard]] double share_by(double dt, std::span<const Touch> touches) const;
    [[nodiscard]] double most_share() const override { return share_; }
    void read(double dt, std::span<Touch> touches);
    void read_steps(double dt);
    void add_load(const Wrench& wrench, int segment, double dt);

    dBodyID user_;
    std::shared_ptr<const WorldLife> life_;
    dMass mass_{}; ///< as the user made it
    JointFrame<double> first_in_body_, whole_in_body_;
    std::unique_ptr<MemberGeoms> geoms_;
    World* world_ = nullptr;
    double share_ = 0;                                   ///< as most_share
    bool is_missing_ = false;                            ///< the World does not have its body
    std::vector<std::pair<dJointID, MemberPlace>> told_; ///< which places joints hold
    std::vector<PieceCourse> before_;                    ///< by piece
    PressedTouches pressed_;                             ///< of a clamped one that is whole
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/member.ipp"
#endif
