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
// open nothing. So is one that constraints hold as soon as it might be, and one on which contacts
// still close that could load it: what sweeps leave sinks, and would be caught with a jerk.
//
// Read are the impulses of contact points, the joint feedback of what holds on to a member, its own
// forces and gravity. What sleeps on a clamped member, or hangs on it, acts on it as it did when it
// was last solved. A member that these could not load beyond its strength with the largest arms
// that they can have is not looked at more closely. A clamped one that is whole is not looked at at
// all where nothing touched it, once gravity alone did not yield it.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ductile/bullet/divisible.hpp"
#include "ductile/bullet/divisibles.hpp"
#include "ductile/bullet/member.hpp"
#include "ductile/bullet/touching_islands.hpp"
#include "ductile/bullet/world.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

/// Of one divisible.
struct DivisibleTicks {
    static constexpr int at_once = 60;

    Divisible* of;
    const Member* member; ///< null: a structure
    std::vector<int> found{};
    std::vector<const btCollisionObject*> bodies{}; ///< as Members::owners_ has them
    int direct = 0;                                 ///< ticks for which it is still solved at once
    double left = 0;      ///< of contacts in this tick, by sweeps [N s]; infinite: one gives way
    bool asked = true;    ///< for its report
    bool watched = false; ///< in every tick
    bool here = false;    ///< in this one
};

class Members final : public DivisibleList<Divisibles, DivisibleTicks> {
  public:
    explicit Members(btDiscreteDynamicsWorld& world) : world_(world) {}
    ~Members() override {
        for (Course& course : members_) course.of->leave();
    }

    /// What is to be said of it.
    /// @throws as World::add.
    [[nodiscard]] std::vector<std::string> add(Member& member, std::function<void()> ends);
    void remove(Member& member);
    /// It enters and leaves the world by itself.
    void add(Divisible& structure);
    void remove(Divisible& structure);
    /// Its bodies are others than they were, and not by a step.
    void rearranged(const Divisible& structure);
    /// Bodies whose islands are solved at once.
    [[nodiscard]] const DirectBodies& direct() const noexcept { return direct_; }
    [[nodiscard]] bool has(const Member& member) const noexcept;
    [[nodiscard]] JointReport<double> report(const Member& member) const { return member.report(); }

    // ---- what the world's steps ask

    DUCTILE_INLINE void require_known() const override;
    /// One that was not there was where Bullet has it from.
    DUCTILE_INLINE void list_driven() override;
    [[nodiscard]] DUCTILE_INLINE const void* key_of(const PlasticConstraint& joint,
                                                    int& section) const override;
    [[nodiscard]] DUCTILE_INLINE double closed_work() const override;
    [[nodiscard]] DUCTILE_INLINE double idle_work() const override;
    [[nodiscard]] DUCTILE_INLINE double unmissed_work() const override;
    [[nodiscard]] bool is_member(const btCollisionObject& object) const override {
        return owners_.contains(&object);
    }
    [[nodiscard]] const void* owner_of(const void* body) const override {
        const auto owner = owners_.find(static_cast<const btRigidBody*>(body));
        return owner != owners_.end() ? members_[owner->second].of : nullptr;
    }
    [[nodiscard]] DUCTILE_INLINE std::vector<int> held_islands() const override;
    DUCTILE_INLINE void apply_forces() override;
    DUCTILE_INLINE void drop_forces() override;
    DUCTILE_INLINE void before_solve() override;
    [[nodiscard]] DUCTILE_INLINE bool look(double dt) override;
    DUCTILE_INLINE void begin_blow(std::span<const btRigidBody* const> closing, bool thrown,
                                   double noticed) override;
    [[nodiscard]] DUCTILE_INLINE bool look_blow(double dt) override;
    DUCTILE_INLINE void open_found() override;
    [[nodiscard]] DUCTILE_INLINE bool close_held(Closing when) override;
    [[nodiscard]] DUCTILE_INLINE double count_vibration() const override;
    DUCTILE_INLINE void tell_idle(const TellIdle& tell) override;

  private:
    using Course = DivisibleTicks;
    void count_own(int before);
    [[nodiscard]] Course* course_of(const btCollisionObject& object);
    void add(Course course);
    void remove(std::size_t course);
    /// What is known of its bodies is of now.
    void note_bodies(std::size_t course);
    /// It was looked at, and may have met what it cannot be asked.
    void note_doubts(Course& course);
    /// Those of the last tick were told.
    void forget_doubts();
    /// Bullet makes no contacts of what does not move with what is driven.
    void see_driven();
    /// It is looked at in this tick.
    void list(Course& course);
    void read_sums(double dt, bool blow);
    /// That sweeps may leave of contacts with a member in a tick of `dt` [s] [N s].
    [[nodiscard]] static double noticed_impulse(const Course& course, double dt);
    /// False where it has to be solved for at once first.
    [[nodiscard]] bool is_decided(Course& course);

    btDiscreteDynamicsWorld& world_;
    std::unordered_map<const btCollisionObject*, std::size_t> owners_;
    std::vector<std::size_t> watched_; ///< that may change without being touched
    std::vector<Course*> here_;        ///< that are looked at in this tick
    std::vector<Member*> pushed_;      ///< with forces
    btVector3 gravity_{0, 0, 0};       ///< of the last look
    bool look_at_all_ = true, any_doubts_ = false;
    int objects_ = 0;                                          ///< of the world, in the last tick
    std::vector<std::pair<btRigidBody*, btTransform>> driven_; ///< of them, where they were then
    std::vector<std::pair<const void*, bool>> idle_changes_;
    std::vector<BodyBefore> before_; ///< by the body's place in the world
    DirectBodies direct_;
    struct Asleep {
        Course* course;
        ContactTouch touch;
        double sum; ///< of impulses, of the tick in which they acted [N s]
    };
    std::vector<Asleep> asleep_; ///< on clamped members
    /// Length of the last tick in which contacts acted on a clamped member [s].
    std::unordered_map<const btPersistentManifold*, double> acted_;
    mutable std::optional<double> closed_work_, idle_work_, unmissed_work_; ///< while bodies stay
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/members.ipp"
#endif
