// SPDX-License-Identifier: MIT
//
// An ODE world as a frame asks for it (frame/part_engine.hpp): parts, what they told, and the world
// as it was before them.
//
//   part    half a step ahead (half_ahead.hpp), contacts there, a step of h, the rest of the way
//   blow    a step of a nanosecond in which contacts of islands with plastic joints are closed and
//           all others open; nothing is pushed apart, and nothing moves
//   ERP, compliance of contacts by the length of the part (frame/part_settings.hpp), those that a
//           contact has for itself too: its joint is then made once more; those of other joints, of
//           their stops and suspensions (own_settings.hpp)
//   damping of the bodies by its share for the part
//   kinematic bodies go on with the velocity they had, to where the user's leads
//           (world/driven_course.hpp)
//
// User's forces act in every part. Contacts are made for each part, and where gaps are looked for,
// by who was given to World::on_contacts.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/frame/part_engine.hpp"
#include "ductile/ode/closing_contacts.hpp"
#include "ductile/ode/contact_maker.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/divisibles.hpp"
#include "ductile/ode/energy_meter.hpp"
#include "ductile/ode/half_ahead.hpp"
#include "ductile/ode/held_forces.hpp"
#include "ductile/ode/island_numbers.hpp"
#include "ductile/ode/local_scope.hpp"
#include "ductile/ode/own_settings.hpp"
#include "ductile/ode/resting_islands.hpp"
#include "ductile/ode/standing_world.hpp"
#include "ductile/ode/thrown_bodies.hpp"
#include "ductile/ode/world_snapshot.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/driven_course.hpp"
#include "ductile/world/turned_contact.hpp"

namespace ductile::ode {

class WorldParts final : public PartEngine {
  public:
    /// What a World has, and what it does.
    struct Parts {
        dWorldID world;
        const std::vector<dBodyID>& bodies; ///< all that move
        const std::vector<PlasticConstraint*>& joints;
        std::vector<NamedContact>& contacts; ///< of the coming step
        std::optional<ContactMaker>& maker;
        EnergyMeter& meter;
        bool keeps_ledger = true;
        const std::unique_ptr<Divisibles>& members;
        std::function<void(double)> solve; ///< ODE's step, with what joints do before it [s]
        std::function<void(double)> step;  ///< ODE's alone [s]
        std::function<void(double)> book;  ///< it is what the joints did [s]
        std::function<std::size_t(const PlasticConstraint&)> number;
        std::function<void(double)> accept; ///< a part of this length stands [s]
    };

    explicit WorldParts(Parts parts) : of_(std::move(parts)) {}
    ~WorldParts() { leave(); }
    WorldParts(const WorldParts&) = delete;
    WorldParts& operator=(const WorldParts&) = delete;

    /// A force that was applied at a place, as HeldForces::place.
    void place(dBodyID body, const Vector3<double>& force, const Vector3<double>& at) {
        forces_.place(body, force, at);
    }
    /// A frame of `length` [s] begins, with the forces that are applied for it.
    void begin(double length);
    /// It is over.
    void end();
    /// To be called before a body is destroyed, in a frame too.
    void forget(dBodyID body);
    /// A body is new, in a frame too.
    void came(dBodyID body);

    /// A plastic joint came or went.
    void joints_changed() noexcept {
        standing_.forget_joints();
        slept_ = false;
    }
    /// Whether nothing is awake, nor was in the last frame. Members may be loaded where they sleep.
    [[nodiscard]] bool sleeps() const {
        return slept_ && of_.members->empty() &&
               std::all_of(of_.bodies.begin(), of_.bodies.end(),
                           [](dBodyID body) { return dBodyIsEnabled(body) == 0; });
    }

    [[nodiscard]] DUCTILE_INLINE bool may_be_put_back() override;
    DUCTILE_INLINE void save() override;
    DUCTILE_INLINE void put_back() override;
    DUCTILE_INLINE const PartMotion& part(double h) override;
    DUCTILE_INLINE const PartMotion& blow() override;
    DUCTILE_INLINE void accept(double h) override;
    [[nodiscard]] DUCTILE_INLINE ClosingContacts closing(double h, double touching,
                                                         double apart) override;
    [[nodiscard]] DUCTILE_INLINE double kinetic_energy() const override;
    [[nodiscard]] bool was_misread() const override {
        return std::any_of(driven_.begin(), driven_.end(),
                           [](const Driven& driven) { return driven.course.was_misread(); });
    }

  private:
    class Settings;
    struct Damped {
        dBodyID body;
        dReal linear, angular;
    };

    /// The user's velocity of a kinematic body is its mean one over the frame.
    struct Driven {
        dBodyID body;
        BodyState<double> mean;
        DrivenCourse course;
    };

    struct Soft {
        SoftContact law;
        dJointID joint;
        ContactClosing it;
        double start;  ///< speed at which it opens as the part begins [m/s]
        double turned; ///< that it has more as it ends, as it turns [m/s]
    };

    struct Push {
        Vector3<double> point, force; ///< world [m], on the first body [N]
    };

    /// What a frame set is as it was.
    void leave();
    /// What it set of the bodies alone, and that it sets it.
    void leave_bodies();
    void begin_bodies();
    /// Does what changes bodies of members, and tells the ledger.
    template <class Change>
    void rearrange(const Change& change);
    void begin_blow();
    /// Hands threw what hangs together with a plastic joint or a member.
    [[nodiscard]] bool is_thrown();
    void see_coming();
    void close_held(Closing when);
    void do_again();
    void begin_driven();
    void drive_as_at(double time) const;
    void drive_to_end(double time, double h) const;
    void drive(const Vector3<double>& velocity, const Vector3<double>& spin, dBodyID body) const;
    void tick(double h, bool blow);
    void go_ahead(double h, double half);
    /// Of the contacts, by `step`.
    void solve(double h, bool blow, const std::function<void(double)>& step);
    /// The engine's gyroscopic moments take no energy in the coming part (joint/gyroscopic.hpp).
    void keep_spins(double h);
    void damp(double share);
    void drop_forces();
    void see_contacts();
    void wake_touched() const;
    /// The bodies are elsewhere, or other ones.
    void moved() {
        looked_ = false;
        stir_.reset();
    }
    /// No contact can close in a part of `h` [s] with more than `least` [J].
    [[nodiscard]] bool is_still(double h, double least) const;
    [[nodiscard]] const Stir& stir() const;
    /// The frame does not go on: forces are as they were.
    void break_off();
    /// Contacts where the bodies are, and which of them close. Bodies that were `moved` are put
    /// back where that throws. `still`: none closes.
    void look(const WorldSnapshot* moved = nullptr, bool still = false);
    /// A contact's own ERP and compliance are those of the part.
    void rule_contacts(double h, bool blow);
    [[nodiscard]] bool is_thrown_out(double depth, double h) const;
    /// A contact that gives way, for a part of `h` [s].
    void soften(NamedContact& named, const ContactClosing& it, const SoftContact& soft, double h);
    void tell_of_soft(double h);
    /// How fast one that is `depth` [m] deep may come nearer, in the middle of a part of `h` [s]
    /// [m/s]. What slides and is not `plastic` is closed too, or loses its contacts by a micrometre
    /// and falls for the part.
    [[nodiscard]] double closes(const ContactClosing& it, double depth, double h,
                                bool plastic) const;
    /// w of world/turned_contact.hpp, in the middle of a part of `h` [s] [m/s].
    [[nodiscard]] double turned(const ContactClosing& it, double h) const;
    void hold_turning(NamedContact& named, const ContactClosing& it, double h);
    /// Contacts begin with what the nearest one of their bodies bore in the last part.
    void begin_pushes();
    void remember_pushes();
    void open_others();
    const PartMotion& tell();
    [[nodiscard]] double next_gap(double h, double apart);

    // ---- islands that are done in parts alone

    /// Those that move, meet, and are stepped now.
    [[nodiscard]] std::span<const dBodyID> bodies() const {
        if (!local_) return of_.bodies;
        return out_ ? scope_.out() : scope_.in();
    }
    [[nodiscard]] std::span<const dBodyID> aside() const {
        if (!local_) return {};
        return out_ ? scope_.in() : scope_.out();
    }
    /// As the frame begins: those that no part can be of go through all of it; true where there are
    /// so many that it pays.
    bool go_local();
    void widen();
    /// Those that are out go on by `h` [s], as one part.
    void tick_out(double h);
    /// Some that are out come in, with theirs, as they are by now.
    void join(std::vector<dBodyID> met);
    /// Those that the last look found touching one that is in; false: none.
    bool join_touched();
    void leave_aside();

    Parts of_;
    double length_ = 1;               ///< of the frame [s]
    double time_ = 0, kept_time_ = 0; ///< since it began [s]
    std::vector<Driven> driven_, last_driven_;
    ThrownBodies thrown_;
    HalfAhead half_ahead_;
    OwnSettings own_settings_;
    HeldForces forces_;
    std::vector<dBodyID> asleep_; ///< when the frame began, with forces on them
    bool slept_ = false;          ///< all did, from the last frame's begin to its end
    std::vector<Damped> damped_;
    RestingIslands resting_;
    StandingWorld standing_;
    IslandNumbers islands_;
    mutable std::optional<Stir> stir_; ///< of the bodies as they are
    bool still_ = false;               ///< before the coming part
    bool metered_ = true;              ///< the coming part is
    WorldSnapshot snapshot_, looked_from_;
    LocalScope scope_, joining_;
    WorldSnapshot began_; ///< those that are out, as the frame began
    bool may_be_local_ = false, local_ = false;
    bool out_ = false;             ///< those that are out of it are at work
    std::vector<dBodyID> touched_; ///< that are out, by contacts of those that are in
    ClosingContactsFinder closing_;
    std::vector<std::pair<AttachedBodies, SeenContact>> seen_, kept_seen_; ///< as a part starts
    std::vector<std::pair<AttachedBodies, Push>> pushes_, kept_pushes_;    ///< of the last part
    bool looked_ = false; ///< where the bodies are, and as fast as they are
    double apart_ = std::numeric_limits<double>::infinity(); ///< energy of a gap that counts [J]
    double touching_ = 0;                                    ///< of what touches [J]
    double closed_ = 0;                                      ///< in the middle of the part [s]
    std::vector<Soft> soft_;                                 ///< of the part
    std::vector<AttachedBodies> parted_;                     ///< by joints that broke
    PartMotion motion_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/world_parts.ipp"
#endif
