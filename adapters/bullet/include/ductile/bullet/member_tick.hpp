// SPDX-License-Identifier: MIT
//
// A member in one tick: what acted on it, and how its pieces went through it, as the core wants to
// know it (member/member_course.hpp).
//
// Not thread-safe.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btVector3.h>

#include <span>
#include <vector>

#include "ductile/bullet/member.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// Velocities before the tick.
struct BodyBefore {
    btVector3 velocity, spin;
};

class MemberTick {
  public:
    explicit MemberTick(Member& member) : member_(&member) {}

    [[nodiscard]] Member& member() const noexcept { return *member_; }
    /// By piece.
    [[nodiscard]] const std::vector<PieceStep>& steps() const noexcept { return steps_; }
    [[nodiscard]] const std::vector<MemberLoad>& loads() const noexcept { return loads_; }
    [[nodiscard]] const MemberStrike& strike() const noexcept { return strike_; }
    [[nodiscard]] bool touched() const noexcept { return !touches_.empty(); }

    /// The pieces are where the tick solves them.
    void begin();
    /// Contacts with impulses that add up to `sum` [N s] acted on it, as body A or B of these.
    void touch(const btPersistentManifold& manifold, bool of_a, double sum) {
        touches_.push_back({&manifold, of_a});
        sum_ += sum;
    }
    /// Contacts are known: adds up the rest.
    void sum_up(double dt) {
        read_constraints(dt, false);
        read_forces(dt, false);
    }
    /// Whether what acted on it could load a section beyond its strength. `before`: by place in the
    /// world.
    [[nodiscard]] bool may_be_beyond(double dt, std::span<const BodyBefore> before,
                                     const btVector3& gravity) const;
    /// Lists all.
    void read(double dt, std::span<const BodyBefore> before, const btVector3& gravity);

  private:
    struct Touch {
        const btPersistentManifold* manifold;
        bool of_a;
    };

    void read_contact(const btPersistentManifold& manifold, bool of_a,
                      std::span<const BodyBefore> before);
    /// Sums what acted, and lists it where `lists`.
    void read_constraints(double dt, bool lists);
    void read_forces(double dt, bool lists);
    void finish_steps(double dt, std::span<const BodyBefore> before, const btVector3& gravity);
    [[nodiscard]] static int segment_at(const Member& member, std::size_t piece,
                                        const JointFrame<double>& pose,
                                        const Vector3<double>& point);

    Member* member_;
    std::vector<PieceStep> steps_;
    std::vector<Touch> touches_;
    std::vector<MemberLoad> loads_;
    MemberStrike strike_;
    double sum_ = 0; ///< of impulses [N s]
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/member_tick.ipp"
#endif
