// SPDX-License-Identifier: MIT
//
// The members of a World: what acted on them in a step, read after it, and which of them it was
// solved for in vain.
//
//   before_solve()  the bodies are where the coming step solves them
//   after_solve()   they have their new velocities
//   look(dt)        joints have booked; true: put the step back, open_found(), do it again
//   look_blow(dt)   the same of a blow
//   close_held()    it stands: what held is one body
//
// Read is the feedback of contacts and of joints that hold on to a member, its own forces and
// gravity. Joints without feedback are lent some for the step.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <deque>
#include <span>
#include <vector>

#include "ductile/ode/divisible.hpp"
#include "ductile/ode/divisibles.hpp"
#include "ductile/ode/member.hpp"
#include "ductile/ode/world.hpp"
#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

/// Of one divisible.
struct DivisibleSteps {
    Divisible* of;
    std::vector<dBodyID> bodies{};
    std::vector<Touch> touches{};
    std::vector<int> found{};
};

class Members final : public DivisibleList<Divisibles, DivisibleSteps> {
  public:
    void add(Divisible& member);
    void remove(Divisible& member);

    // ---- what the World's steps ask

    void rearranged() override { note_bodies(); }
    DUCTILE_INLINE void leave() override;
    [[nodiscard]] std::span<const dBodyID> bodies() const noexcept override { return bodies_; }
    [[nodiscard]] DUCTILE_INLINE const void* key_of(const PlasticConstraint& joint,
                                                    int& section) const override;
    [[nodiscard]] const void* owner_of(const void* body) const override {
        const std::size_t* owner = owners_.find(body);
        return owner != nullptr ? members_[*owner].of : nullptr;
    }
    DUCTILE_INLINE void body_left(dBodyID body) override;
    DUCTILE_INLINE void body_came(dBodyID body) override;
    [[nodiscard]] DUCTILE_INLINE bool hang_together(dBodyID a, dBodyID b) const override;
    [[nodiscard]] DUCTILE_INLINE bool hold(dBodyID a, dBodyID b) const override;
    DUCTILE_INLINE void require_possible() const override;
    DUCTILE_INLINE void apply_forces() override;
    DUCTILE_INLINE void drop_forces() override;
    DUCTILE_INLINE void see_ahead(std::span<const NamedContact> contacts) override;
    DUCTILE_INLINE void see_along(std::span<const dBodyID> bodies, double dt) override;
    DUCTILE_INLINE void before_solve(std::span<const NamedContact> contacts) override;
    [[nodiscard]] DUCTILE_INLINE std::vector<dBodyID> touched() const override;
    [[nodiscard]] std::span<const dJointID> held_by() const override { return held_by_; }
    DUCTILE_INLINE void after_solve() const override;
    [[nodiscard]] bool look(double dt) override { return look(dt, false); }
    DUCTILE_INLINE void begin_blow(double noticed) const override;
    [[nodiscard]] bool look_blow(double dt) override { return look(dt, true); }
    DUCTILE_INLINE void open_found(bool ahead) override;
    [[nodiscard]] DUCTILE_INLINE bool close_held(Closing when, bool ahead) override;
    [[nodiscard]] DUCTILE_INLINE double count_vibration() const override;

  private:
    using Course = DivisibleSteps;

    void note_bodies();
    [[nodiscard]] bool look(double dt, bool blow);
    void list_contacts(std::span<const NamedContact> contacts);
    static void require_named(const Course& course);
    /// ODE makes nothing of contacts between what does not move and what is driven.
    [[nodiscard]] static bool is_passed(const Course& course);
    [[nodiscard]] const dJointFeedback* feedback_of(dJointID joint);
    void take_feedback_back();

    std::vector<const Course*> passed_; ///< in the coming part
    std::vector<dBodyID> bodies_;
    AddressMap<std::size_t> owners_; ///< by body
    std::deque<dJointFeedback> lent_;
    std::vector<dJointID> borrowers_, held_by_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/members.ipp"
#endif
