// SPDX-License-Identifier: MIT
//
// A Bullet world as a frame asks for it (frame/part_engine.hpp): parts, what they told, and the
// world as it was before them.
//
//   part    half a step ahead (half_ahead.hpp), a tick of h, the rest of the way within it
//   blow    a tick of a nanosecond in which contacts of islands with plastic joints that touch are
//           closed and all others open (front_solver.hpp); nothing is pushed apart
//   member  one with a section beyond its strength opens it, and the part or blow is done again
//   ERP     by the length of the part (part_settings.hpp)
//
// User's forces act in every part. Motion states are told once, at the end of the frame. Tick
// callbacks and actions are called for each tick, also of parts that are put back, and have to
// allow that. A hinge's motor and the clamp of a point, which Bullet bounds by an impulse a tick,
// have in each part its share of that. Kinematic bodies go their way over the frame
// (driven_ways.hpp).
//
// Locality. Where little of the world may have to be put back, the first part is one of all, as
// long as the frame. What was in trouble in it is put back alone, and done in parts by
// local_tick.hpp, while the rest keeps what it has, bit for bit:
//
//   in trouble   islands, before or after that part, with a plastic row that moved, a joint that
//                broke, a contact that closes; islands that these may reach within the frame
//   members      where one is open, or something closes: all, with the islands of what they hold or
//                touch; else nothing is done alone
//   met          an island that one of these is about to touch, or does, is put back to the
//                frame's begin, brought to where the part begins by a part of its own, and comes
//                along; a part that found it is done again
//
// Not so with kinematic bodies, continuous collision, callbacks and actions, or worlds and solvers
// of another kind, nor where half of the bodies are in trouble: then all is done again.
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/constraint_stops.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/half_ahead.hpp"
#include "ductile/bullet/held_contacts.hpp"
#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/lent.hpp"
#include "ductile/bullet/local_scope.hpp"
#include "ductile/bullet/local_tick.hpp"
#include "ductile/bullet/meeting_islands.hpp"
#include "ductile/bullet/part_risk.hpp"
#include "ductile/bullet/thrown_bodies.hpp"
#include "ductile/bullet/world_snapshot.hpp"
#include "ductile/frame/part_engine.hpp"
#include "ductile/member/closing.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class FrontHold;
class Divisibles;

class WorldParts final : public PartEngine {
  public:
    /// Number of a plastic joint as reports know it.
    using Number = std::function<std::size_t(const PlasticConstraint&)>;
    /// A part of this length stands [s].
    using Accept = std::function<void(double)>;

    WorldParts(btDiscreteDynamicsWorld& world, FrontHold& front, EnergyMeter& meter,
               const std::unique_ptr<Divisibles>& members, Number number, Accept accept,
               bool keeps_ledger = true);
    DUCTILE_INLINE ~WorldParts();
    WorldParts(const WorldParts&) = delete;
    WorldParts& operator=(const WorldParts&) = delete;

    /// A force that was applied at a place, as HeldForces::place.
    void place(btRigidBody& body, const Vector3<double>& force, const Vector3<double>& at) {
        forces_.place(body, force, at);
    }
    /// A frame of `length` [s] begins, with the forces that are applied for it.
    void begin(double length);
    /// It is over.
    void end();
    /// True where the frame, since its begin or until the next one, does some islands again alone.
    [[nodiscard]] bool is_local() const noexcept { return local_; }
    /// Whether a joint, by its address as a constraint, is in none of those.
    [[nodiscard]] bool is_outside(const void* joint) const {
        return std::binary_search(outside_.begin(), outside_.end(), joint);
    }
    /// Joints have other numbers from now on.
    void forget_numbers() noexcept { numbers_.clear(); }

    [[nodiscard]] DUCTILE_INLINE bool may_be_put_back() override;
    DUCTILE_INLINE void save() override;
    DUCTILE_INLINE void put_back() override;
    DUCTILE_INLINE const PartMotion& part(double h) override;
    DUCTILE_INLINE const PartMotion& blow() override;
    DUCTILE_INLINE void accept(double h) override;
    [[nodiscard]] DUCTILE_INLINE ClosingContacts closing(double h, double touching,
                                                         double apart) override;
    [[nodiscard]] DUCTILE_INLINE double kinetic_energy() const override;
    [[nodiscard]] DUCTILE_INLINE double rounding(double h) const override;
    [[nodiscard]] bool was_misread() const override { return ways_.was_misread(); }

  private:
    class HingeMotors;
    static void rule(btContactSolverInfo& info, btScalar h, double frame, bool blow,
                     Lent<btScalar>& lent, Lent<int>& modes);
    void share_brakes(btScalar share, Lent<btScalar>& lent);
    void tick(double h, bool ahead);
    /// The same, with whom it touched.
    void tick_with_met(double h, bool ahead);
    /// The engine's gyroscopic moments take no energy in the coming part (joint/gyroscopic.hpp).
    void keep_spins(double h);
    [[nodiscard]] LocalScope* scope() noexcept { return local_ ? &scope_ : nullptr; }
    [[nodiscard]] const LocalScope* scope() const noexcept { return local_ ? &scope_ : nullptr; }

    // ---- islands that are done again alone

    /// Once a frame, where something may have to be put back: whether that is done alone.
    void decide();
    void find_risk();
    [[nodiscard]] bool is_little() const;
    void try_all();
    [[nodiscard]] bool most_stands() const;
    /// All that moves is ticked alone.
    void leave_what_stands();
    [[nodiscard]] std::vector<btRigidBody*> find_trouble(std::vector<char>& chosen);
    void add_reached(std::vector<char>& chosen) const;
    void look_at(const LocalScope& scope);
    void narrow_to(LocalScope& scope);
    void widen();
    void go_back_alone(LocalScope& scope);
    /// Bodies of members, and what these hold or meet.
    void choose_members(std::vector<char>& chosen);
    /// Bodies of members came or went.
    void see_members();
    /// Islands of these come along from now on.
    void join(const std::vector<btRigidBody*>& met);
    /// Those of bodies that the last tick touched; true where there were some, and the tick was put
    /// back.
    [[nodiscard]] bool join_touched();
    /// Something threw.
    void break_off();

    [[nodiscard]] std::span<btPersistentManifold* const> manifolds();
    [[nodiscard]] bool concerns(const btCollisionObject& object);
    void see_stops(double h, ClosingContacts& found);
    /// It is Bullet's own, in an island with plastic joints.
    [[nodiscard]] bool has_part_stops(btTypedConstraint& constraint);
    void take_stops(PartStops& stops);
    /// When a gap closed or a stop was met that was not foreseen; 0: none [s].
    [[nodiscard]] double closed_early(double h);
    void look_at_pushes(double h);

    /// Back to before it, with the sections open that it was beyond.
    void begin_blow();
    void find_thrown();
    void see_coming();
    void close_held(Closing when);
    void see_bodies();
    void do_again();
    const PartMotion& tell();
    /// `place`: of the joint among the world's constraints.
    [[nodiscard]] std::size_t number(int place, const PlasticConstraint& joint);

    btDiscreteDynamicsWorld& world_;
    FrontHold& front_;
    EnergyMeter& meter_;
    const std::unique_ptr<Divisibles>& members_;
    Number number_;
    Accept accept_;
    HalfAhead half_ahead_;
    MeetingIslands* islands_; ///< the world's; null: it kept its own
    DrivenWays ways_;
    double length_ = 0;               ///< of the frame [s]
    double time_ = 0, kept_time_ = 0; ///< since its begin [s]
    bool kept_ = false;               ///< what is kept may be put back
    HeldForces forces_;
    WorldSnapshot snapshot_;
    ClosingContactsFinder closing_;
    HeldContacts held_;
    ThrownBodies thrown_;
    double half_ = 0;     ///< of the last part that stands, since which bodies went straight on [s]
    double stop_met_ = 0; ///< in the last part, unforeseen; infinite: none [s]
    double touching_ = 0, apart_ = 0; ///< energies that a contact, a gap has to close with [J]
    bool closes_ = false;             ///< a contact, as the last look ahead found
    PartRisk risk_;
    bool same_forces_ = false;  ///< as in the last frame
    bool keeps_ledger_;         ///< else only parts that are judged are metered
    bool at_risk_ = true;       ///< something of the frame
    bool looked_ = false;       ///< for that
    bool calls_others_ = false; ///< callbacks and actions of the user's
    PartMotion motion_;
    std::vector<std::pair<const PlasticConstraint*, std::size_t>> numbers_; ///< by place
    std::vector<std::size_t> first_row_;                                    ///< by place
    std::vector<PartRow> rows_;                                             ///< of one joint
    std::vector<const btRigidBody*> suspects_; ///< of joints at risk, and of contacts that close
    std::vector<char> were_enabled_;           ///< by place, before the trial
    WorldSnapshot frame_;                      ///< all, as the frame began
    LocalScope scope_, joining_;
    LocalTick local_tick_;
    bool decided_ = false, local_ = false;
    bool narrow_ = false;              ///< others look at the scope alone
    double outside_work_ = 0;          ///< plastic, of joints outside of the scope [J]
    std::vector<const void*> outside_; ///< these, sorted
    bool forces_act_ = false;          ///< they are applied for the coming tick
    bool pairs_were_sorted_;           ///< the user's setting
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/world_parts.ipp"
#endif
