// SPDX-License-Identifier: MIT
//
// The members of a world: what acted on them in a tick, read after it, and which of them it was
// solved for in vain.
//
//   before_solve()       the bodies are where the coming tick solves them
//   look(dt)             after it; true: put the tick back, open_found(), do it again
//   look_blow(dt)        the same of a blow
//   close_held()         it stands; true: bodies came or went
//
// What is decided from impulses needs impulses that are solved. A whole member whose impulses, as
// the user's solver left them, are beyond its strength is first solved for again, at once
// (front_solver.hpp), and stays so as long as it might be beyond: sweeps that have not converged
// open nothing.
//
// Read are the impulses of contact points, the joint feedback of what holds on to a member, its own
// forces and gravity. A member that these could not load beyond its strength, whatever their arms,
// is not looked at more closely: that costs some hundred instructions a body.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <cstddef>
#include <functional>
#include <vector>

#include "ductile/bullet/member_tick.hpp"
#include "ductile/bullet/touching_islands.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/joint_event.hpp"

namespace ductile::bullet {

class Members {
  public:
    /// A section opened or closed: of whom, which, what happened.
    using Tell = std::function<void(const Member&, int section, EventKind kind)>;

    explicit Members(btDiscreteDynamicsWorld& world) : world_(world) {}
    ~Members() {
        for (Course& course : members_) course.tick.member().leave();
    }
    Members(const Members&) = delete;
    Members& operator=(const Members&) = delete;

    /// @throws as World::add.
    void add(Member& member, std::function<void()> ends);
    void remove(Member& member);
    /// Bodies whose islands are solved at once.
    [[nodiscard]] const DirectBodies& direct() const noexcept { return direct_; }
    [[nodiscard]] bool empty() const noexcept { return members_.empty(); }
    [[nodiscard]] bool has(const Member& member) const noexcept;
    [[nodiscard]] JointReport<double> report(const Member& member) const { return member.report(); }
    /// How the forces of joints act in the coming ticks.
    void set_share(const ForceShare& share) noexcept { share_ = share; }
    /// Whose joint it is, and of which section; null: no member's.
    [[nodiscard]] const Member* owner(const PlasticConstraint& joint, int& section) const;
    /// Of sections that are closed [J].
    [[nodiscard]] double closed_work() const;
    /// As PartMotion::closed_work.
    [[nodiscard]] double unmissed_work() const;
    /// Bodies may have come and gone since.
    void number_bodies();
    /// As last numbered.
    [[nodiscard]] bool is_member(const btCollisionObject& object) const;

    /// Forces that were applied to members act in the coming tick, too.
    void apply_forces();
    /// They do not any more.
    void drop_forces();

    void before_solve();
    [[nodiscard]] bool look(double dt);
    void begin_blow();
    [[nodiscard]] bool look_blow(double dt);
    void open_found();
    [[nodiscard]] bool close_held();
    /// What opened and closed since the last call.
    void tell(const Tell& tell);

  private:
    struct Course {
        MemberTick tick;
        std::vector<int> found{};
        int direct = 0; ///< ticks for which it is still solved at once
    };
    struct Happened {
        const Member* member;
        int section;
        EventKind kind;
    };
    [[nodiscard]] Course* course_of(const btCollisionObject& object);
    void read_sums(double dt);
    /// False where it has to be solved for at once first.
    [[nodiscard]] static bool is_decided(Course& course);

    btDiscreteDynamicsWorld& world_;
    ForceShare share_;
    std::vector<Course> members_;
    std::vector<int> number_;        ///< of the member, by the body's place in the world
    std::vector<BodyBefore> before_; ///< by the body's place in the world
    DirectBodies direct_;
    std::vector<Happened> happened_;
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/members.ipp"
#endif
