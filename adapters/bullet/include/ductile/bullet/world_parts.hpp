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
// allow that. Kinematic bodies go their way over the frame (driven_ways.hpp).
//
// Not thread-safe.
#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <functional>

#include "ductile/bullet/closing_contacts.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/half_ahead.hpp"
#include "ductile/bullet/held_forces.hpp"
#include "ductile/bullet/meeting_islands.hpp"
#include "ductile/bullet/world_snapshot.hpp"
#include "ductile/frame/part_engine.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::bullet {

class FrontHold;
class Members;

class WorldParts final : public PartEngine {
  public:
    /// Number of a plastic joint as reports know it.
    using Number = std::function<std::size_t(const PlasticConstraint&)>;
    /// A part of this length stands [s].
    using Accept = std::function<void(double)>;

    WorldParts(btDiscreteDynamicsWorld& world, FrontHold& front, EnergyMeter& meter,
               Members& members, Number number, Accept accept);
    ~WorldParts();
    WorldParts(const WorldParts&) = delete;
    WorldParts& operator=(const WorldParts&) = delete;

    /// A frame of `length` [s] begins, with the forces that are applied for it.
    void begin(double length);
    /// It is over.
    void end();

    DUCTILE_INLINE void save() override;
    DUCTILE_INLINE void put_back() override;
    DUCTILE_INLINE const PartMotion& part(double h) override;
    DUCTILE_INLINE const PartMotion& blow() override;
    DUCTILE_INLINE void accept(double h) override;
    [[nodiscard]] DUCTILE_INLINE ClosingContacts closing(double h, double touching,
                                                         double apart) override;
    [[nodiscard]] DUCTILE_INLINE double kinetic_energy() const override;

  private:
    class Settings;
    void tick(double h, bool ahead);
    /// Back to before it, with the sections open that it was beyond.
    void do_again();
    const PartMotion& tell();

    btDiscreteDynamicsWorld& world_;
    FrontHold& front_;
    EnergyMeter& meter_;
    Members& members_;
    Number number_;
    Accept accept_;
    HalfAhead half_ahead_;
    MeetingIslands* islands_; ///< the world's; null: it kept its own
    DrivenWays ways_;
    double time_ = 0, kept_time_ = 0; ///< since the frame's begin [s]
    double frame_ = 1;                ///< its length [s]
    HeldForces forces_;
    WorldSnapshot snapshot_;
    ClosingContactsFinder closing_;
    double apart_ = 0; ///< energy with which a gap has to close to count [J]
    PartMotion motion_;
    bool forces_act_ = false; ///< they are applied for the coming tick
    bool pairs_were_sorted_;  ///< the user's setting
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/world_parts.ipp"
#endif
