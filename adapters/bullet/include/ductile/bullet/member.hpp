// SPDX-License-Identifier: MIT
//
// A member in Bullet: the user's rigid body as long as all its sections hold, several bodies while
// some flow, the user's body again, bent, when the flow has stopped.
//
//   ductile::bullet::World world(dynamics, {.tolerance = 0.01});
//   const auto beam = ductile::beam(section, steel, {.length = 2, .clamped = true});
//   ductile::bullet::Member post(body, beam, start_in_body, {.half_width = 0.05, .half_height =
//   0.05}); world.add(post, "lamp post");
//
// The body. It is the member while that is whole, with its own shape, mass and inertia; of a
// clamped member it is static. While the member is open it is in no world, and its pieces are; it
// is never ended, and in the world again where all sections hold: as it was where none is bent,
// else with a shape and an inertia of bent segments. Its collision filter, friction, restitution,
// damping, factors, flags, gravity and user pointer are also those of the pieces, which collide
// with each other only where a broken section lies between them. `of` finds the member of a body in
// a contact callback. Bodies of pieces end when sections open and close: keep no address of one.
//
// What holds on to it. Constraints cannot change their bodies in Bullet: `attach` makes them anew
// for the piece that has their place; what it joins does not collide with the member. Forces:
// apply_force, as a body's own loses the point where it acted.
//
// Where it ends or leaves its World while it is open it is one body first, bent as it is.
//
// Not thread-safe. Must end before its body and before Bullet's world.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ductile/bullet/attachment.hpp"
#include "ductile/bullet/divisible.hpp"
#include "ductile/bullet/passing_bodies.hpp"
#include "ductile/bullet/piece_maker.hpp"
#include "ductile/bullet/plastic_hinge.hpp"
#include "ductile/joint/usual_joints.hpp"
#include "ductile/member/stepped_member.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// A section that flows, or did.
struct OpenSection {
    int section;
    std::unique_ptr<btJointFeedback> feedback;
    std::unique_ptr<PlasticHinge<UsualAxisJoint>> hinge;
};

/// As member/stepped_member.hpp wants it.
struct MemberParts {
    using Divisible = bullet::Divisible;
    using Joint = PlasticConstraint;
    using OpenSection = bullet::OpenSection;
    using Piece = PieceBody;
    using Hold = Attachment;
};

/// What it says of its sections: member/divided_member.hpp. All of it: member_snapshot.hpp.
class Member final : public SteppedMember<MemberParts> {
  public:
    /// Makes a constraint between a body of the member and whatever it holds; `place`: in that
    /// body, axes of the member.
    using Maker = Attachment::Maker;

    /// `start_in_body`: the member's frame in the frame of the body's centre of mass.
    /// @throws std::invalid_argument where the body is kinematic, is static and the member not
    /// clamped or the other way round, has another mass than the member, its centre elsewhere, or
    /// is a member already, or a frame is none.
    Member(btRigidBody& body, ductile::Member member, const btTransform& start_in_body,
           const MemberBox& box = {});
    DUCTILE_INLINE ~Member() override;

    /// Null for a body that belongs to no member.
    [[nodiscard]] static Member* of(const btCollisionObject* object);

    /// Bodies that it is now, from its start, but for the ground at a held one.
    [[nodiscard]] std::vector<btRigidBody*> pieces() const;
    /// The body that has a segment now.
    [[nodiscard]] btRigidBody& body_of(int segment) const;
    /// Middle of a segment, axes of the member: what to draw.
    [[nodiscard]] btTransform pose(int segment) const;
    /// A constraint at `place` [m] along the member, on its axis, now and whenever bodies change.
    /// To be called before it is added to a World.
    /// @throws std::invalid_argument where the place is beyond the ends or nothing is made;
    /// std::logic_error once it is in a World.
    void attach(double place, Maker maker);
    /// `force` [N] at `place` [m] along the member, world axes, for the next step.
    /// @throws std::invalid_argument where the place is beyond the ends or the force not finite.
    void apply_force(const btVector3& force, double place);

  private:
    friend class Members;
    friend class MemberSnapshot;
    void require_free(const btDiscreteDynamicsWorld& world) const;
    void enter(btDiscreteDynamicsWorld& world);
    /// Lines for the World's user.
    [[nodiscard]] std::vector<std::string> remarks() const;
    void make_attachments();
    void let_pieces_pass();

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
    DUCTILE_INLINE void see_open() override;
    DUCTILE_INLINE void add_force(int segment, const Vector3<double>& force,
                                  const Vector3<double>& at) override;

    // ---- what the world asks
    [[nodiscard]] std::span<const PieceBody> all_pieces() const override { return pieces_; }
    [[nodiscard]] bool idle() const override {
        return whole() && description().clamped() && holds_.empty();
    }
    [[nodiscard]] bool doubts() const override {
        return course_.unmodelled() != Unmodelled::nothing;
    }
    DUCTILE_INLINE void require_possible() const override;
    DUCTILE_INLINE void require_attached(const btTypedConstraint& constraint) const override;
    [[nodiscard]] bool is_held() const override { return !holds_.empty(); }
    DUCTILE_INLINE void leave() override;
    void begin() override {
        course_.begin_step();
        touches_.clear();
        sum_ = 0;
    }
    void touch(const ContactTouch& touch, double sum) override {
        touches_.push_back(touch);
        sum_ += sum;
    }
    void sum_up(double dt) override {
        read_constraints(dt, false);
        read_forces(dt, false);
    }
    [[nodiscard]] bool touched() const override { return !touches_.empty() || is_held(); }
    [[nodiscard]] DUCTILE_INLINE double most_share(double dt, std::span<const BodyBefore> before,
                                                   const btVector3& gravity) const override;
    DUCTILE_INLINE void find_beyond(double dt, std::span<const BodyBefore> before,
                                    const btVector3& gravity, std::vector<int>& sections) override;
    DUCTILE_INLINE void find_struck(double dt, std::span<const BodyBefore> before,
                                    const btVector3& gravity, std::vector<int>& sections) override;

    // ---- a tick
    void read(double dt, std::span<const BodyBefore> before, const btVector3& gravity);
    void read_contact(const ContactTouch& touch, std::span<const BodyBefore> before);
    [[nodiscard]] static bool is_support(const Hold& hold);
    [[nodiscard]] static std::array<bool, 3> borne_by(btTypedConstraint& constraint,
                                                      const btTransform& pose);
    /// Sums what acted, and lists it where `lists`.
    void read_constraints(double dt, bool lists);
    void read_forces(double dt, bool lists);
    /// The largest moment that the contacts of a whole straight member can have given a section,
    /// with what its own motion takes [N m s].
    [[nodiscard]] double largest_moment(double dt, std::span<const BodyBefore> before,
                                        const btVector3& gravity) const;
    [[nodiscard]] bool is_plain() const;
    void finish_steps(double dt, std::span<const BodyBefore> before, const btVector3& gravity);

    btRigidBody& user_;
    std::unique_ptr<PieceMaker> maker_;
    JointFrame<double> held_; ///< where a held segment is
    btDiscreteDynamicsWorld* world_ = nullptr;
    std::function<void()> ends_;       ///< tells the World that it was added to
    std::function<void()> pushed_;     ///< tells it that a force was applied, the first one
    std::function<void()> rearranged_; ///< that its bodies are others
    PassingBodies passing_;            ///< ends before its pieces do
    int broken_ = 0;                   ///< sections, when pieces were last told whom they meet
    std::vector<ContactTouch> touches_;
    MemberStrike strike_;
    double sum_ = 0;                           ///< of impulses [N s]
    double own_about_x_ = 0, own_inertia_ = 0; ///< of its segments, each about its middle [kg m²]
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/member.ipp"
#endif
