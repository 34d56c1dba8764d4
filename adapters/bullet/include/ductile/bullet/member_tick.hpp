// SPDX-License-Identifier: MIT
//
// A member in one tick: what acted on it, and how its pieces went through it, as the core wants to
// know it (member/member_course.hpp).
//
// Not thread-safe.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btVector3.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "ductile/bullet/divisible.hpp"
#include "ductile/bullet/member.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class MemberTick final : public Divisible {
  public:
    explicit MemberTick(Member& member);

    /// Lines for the World's user.
    [[nodiscard]] std::vector<std::string> remarks() const;

    [[nodiscard]] DUCTILE_INLINE std::span<const PieceBody> pieces() const override;
    [[nodiscard]] DUCTILE_INLINE bool idle() const override;
    [[nodiscard]] DUCTILE_INLINE bool whole() const override;
    [[nodiscard]] DUCTILE_INLINE bool doubts() const override;
    DUCTILE_INLINE void driven_through() override;
    [[nodiscard]] DUCTILE_INLINE int section_of(const PlasticConstraint& joint) const override;
    [[nodiscard]] const void* key_of(int /*section*/) const override { return &member_; }
    [[nodiscard]] DUCTILE_INLINE double closed_work() const override;
    [[nodiscard]] DUCTILE_INLINE double unmissed_work() const override;
    DUCTILE_INLINE void require_possible() const override;
    DUCTILE_INLINE void require_attached(const btTypedConstraint& constraint) const override;
    [[nodiscard]] DUCTILE_INLINE bool is_held() const override;
    DUCTILE_INLINE void list_holds(std::vector<const btTypedConstraint*>& list) const override;
    DUCTILE_INLINE void leave() override;

    DUCTILE_INLINE void apply_forces() override;
    DUCTILE_INLINE void drop_forces() override;
    DUCTILE_INLINE void begin() override;
    void touch(const ContactTouch& touch, double sum) override {
        touches_.push_back(touch);
        sum_ += sum;
    }
    void sum_up(double dt) override {
        read_constraints(dt, false);
        read_forces(dt, false);
    }
    [[nodiscard]] bool touched() const override {
        return !touches_.empty() || !member_.attachments_.empty();
    }
    [[nodiscard]] DUCTILE_INLINE bool may_be_beyond(double dt, std::span<const BodyBefore> before,
                                                    const btVector3& gravity) const override;
    DUCTILE_INLINE void find_beyond(double dt, std::span<const BodyBefore> before,
                                    const btVector3& gravity, std::vector<int>& sections) override;
    DUCTILE_INLINE void begin_blow(double noticed) override;
    DUCTILE_INLINE bool switch_holds(bool on) override;
    DUCTILE_INLINE void see_coming() override;
    DUCTILE_INLINE void find_struck(double dt, std::span<const BodyBefore> before,
                                    const btVector3& gravity, std::vector<int>& sections) override;
    DUCTILE_INLINE void open(std::span<const int> sections, bool ahead) override;
    DUCTILE_INLINE double count_vibration() override;
    DUCTILE_INLINE std::vector<int> close_held(Closing when, bool ahead) override;

  private:
    void read(double dt, std::span<const BodyBefore> before, const btVector3& gravity);
    void read_contact(const ContactTouch& touch, std::span<const BodyBefore> before);
    void read_attachments(double dt);
    [[nodiscard]] static bool is_support(const Member::Attachment& attachment);
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
    Member& member_;
    std::vector<PieceStep> steps_;
    std::vector<ContactTouch> touches_;
    std::vector<MemberLoad> loads_;
    MemberStrike strike_, by_joints_;
    double sum_ = 0;                           ///< of impulses [N s]
    double own_about_x_ = 0, own_inertia_ = 0; ///< of its segments, each about its middle [kg m²]
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/member_tick.ipp"
#endif
