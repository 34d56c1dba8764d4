// SPDX-License-Identifier: MIT
//
// Keeps the ledger of a world of any engine, step by step. An adapter derives from it and says
// which bodies, joints and contacts there are.
//
//   meter.before_step();   the engine's step of dt;   meter.after_step(dt);
//
// The update of an engine is v' = v + M⁻¹ Σ impulses, so each impulse's work is impulse × (u +
// u')/2 at its point, and the sum is the change of kinetic energy to round-off. Booked:
//   plastic      what every plastic joint says it absorbed
//   joints       work of all joints, less the plastic part, damping, what elastic ones store,
//                which the world holds, and what a break gave back
//   damping      what every plastic joint says that its material's damping took
//   sleep        motion that ends because the engine puts a body to sleep
//   contact      normal impulses
//   friction     tangential impulses
//   members      what bodies of members that split or fuse change of the world's energy
//   integration  gravity's work against the change of potential energy; damping; gyroscopic
//                torque and the turning of inertia tensors
// What the engine does not tell stays unexplained.
//
// Cost: O(bodies + joints + contacts) per step. Not thread-safe.
#pragma once

#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/vocabulary/address_book.hpp"
#include "ductile/vocabulary/vector.hpp"
#include "ductile/world/joint_queries.hpp"
#include "ductile/world/ledger.hpp"
#include "ductile/world/pair_accounts.hpp"

namespace ductile {

/// A body that can move, world axes. An address stands for a body, here and below; null, or one
/// that is not metered: a body that takes part but holds no energy of this world.
struct MeteredBody {
    const void* body = nullptr;
    Vector3<double> position{0, 0, 0};                 ///< of the centre of mass [m]
    Vector3<double> velocity{0, 0, 0};                 ///< [m/s]
    Vector3<double> spin{0, 0, 0};                     ///< [rad/s]
    double mass = 0;                                   ///< [kg]
    Matrix3<double> inertia = Matrix3<double>::Zero(); ///< about the centre of mass [kg m²]
    Vector3<double> weight{0, 0, 0};                   ///< gravity's force on it [N]
    Vector3<double> force{0, 0, 0};                    ///< applied for the step [N]
    Vector3<double> torque{0, 0, 0};                   ///< [N m]
    bool asleep = false; ///< the engine leaves it alone and keeps no velocity of it
};

/// A plastic joint and its bodies.
struct MeteredPlasticJoint {
    const PairQueries* joint = nullptr;
    const void* a = nullptr;
    const void* b = nullptr;
};

/// What all rows of a joint did in a step, about the centres of mass, world axes.
struct MeteredJoint {
    const void* joint = nullptr;   ///< an address, as taken_by wants it
    const void* account = nullptr; ///< one that stays while it is made anew; null: `joint`
    const void* a = nullptr;
    const void* b = nullptr;
    Vector3<double> force_a{0, 0, 0};  ///< [N]
    Vector3<double> torque_a{0, 0, 0}; ///< [N m]
    Vector3<double> force_b{0, 0, 0};
    Vector3<double> torque_b{0, 0, 0};
    const PairQueries* plastic = nullptr; ///< whose flow is a part of this; null: nobody's
    /// Of a body whose motion is prescribed, or of what is not told apart below: what moves that
    /// pays too.
    bool driven = false;
    bool powered = false; ///< by a motor or spring of the engine's
    /// What its motors, stops and springs did on A, and with the opposite sign on B: all else are
    /// rigid rows, which take nothing of what goes along.
    Vector3<double> own_force{0, 0, 0};    ///< [N]
    Vector3<double> own_torque_a{0, 0, 0}; ///< about A's centre of mass [N m]
    Vector3<double> own_torque_b{0, 0, 0}; ///< on A, about B's
};

/// One contact point of a step.
struct MeteredContact {
    const void* a = nullptr;
    const void* b = nullptr;
    Vector3<double> point_a{0, 0, 0}; ///< world [m]
    Vector3<double> point_b{0, 0, 0};
    Vector3<double> normal{0, 0, 0};     ///< impulse on A [N s]
    Vector3<double> tangential{0, 0, 0}; ///< [N s]
    bool driven = false;                 ///< by a body whose motion is prescribed
    /// Of points of such bodies that are not in the list of bodies, A's less B's [m/s]: what these
    /// give is no work of the contact.
    Vector3<double> driven_velocity{0, 0, 0};
    double taken = 0;   ///< what the normal force took, once it is booked [J]
    bool gives = false; ///< it is a spring and a damper (frame/soft_contact.hpp)
};

class EnergyMeter {
  public:
    EnergyMeter(const EnergyMeter&) = delete;
    EnergyMeter& operator=(const EnergyMeter&) = delete;

    /// Starts a new account with what the world holds now.
    void open();
    [[nodiscard]] const Ledger<double>& ledger() const noexcept { return ledger_; }
    /// Books as from outside what somebody changed since the last step.
    void see_changes();
    /// `watches`: all contacts are there; else watch_step is to be called once they are.
    void before_step(bool watches = true);
    /// The bodies were moved half a step ahead since before_step (frame/README.md): rows are solved
    /// where they are now.
    void bodies_ahead();
    /// After it: a gyroscopic impulse that is given beside the engine's own [N m s].
    void add_gyroscopic(const void* body, const Vector3<double>& impulse);
    /// Books the step of `dt` [s] that was opened by `before_step`.
    void after_step(double dt);
    /// Between two steps bodies of members were split or made one, or what `account` says happened
    /// to them; `before`: held().total() before [J].
    void bodies_rearranged(double before, Account account = Account::members);
    /// Of the flow that was booked, `energy` was elastic and rings down [J].
    void rings_down(double energy);
    /// Keeps the account for one put_back or more, before `before_step`.
    void keep();
    void put_back();
    // ---- a step of some of the bodies (frames that do again what is in trouble alone)

    /// Keeps what the step just booked needs to be taken back of some of its bodies.
    void keep_step(double dt);
    /// From now on the lists are of some of the bodies alone, or again of all (`all`). What the
    /// others hold is taken to stay. `begins`: the next step begins one of all, done in turn.
    void narrow(bool all = false, bool begins = false);
    /// Takes back what the kept step booked of the bodies listed now, which are as it left them.
    void take_back();
    /// They were put elsewhere, by what is no step.
    void moved_back();
    /// Of the last step alone: what plastic joints took beside their flow, damping and what they
    /// store, but for driven ones [J].
    [[nodiscard]] double step_of_plastic_joints() const noexcept { return step_plastic_; }
    /// What rigid rows of the engine's joints took in it, on islands with plastic joints [J].
    [[nodiscard]] double step_of_other_joints() const noexcept { return step_others_; }
    /// What elastic joints held at its end [J].
    [[nodiscard]] double stored() const noexcept { return last_.elastic; }
    /// What contacts of bodies that count took in it, but for those that give way [J].
    [[nodiscard]] double step_of_contacts(const std::function<bool(const void*)>& counts) const;
    /// Of bodies that are one's pieces, whose; null: nobody's. What gives way takes from one of
    /// them and gives to another.
    void set_owners(std::function<const void*(const void* body)> owner_of) {
        owner_of_ = std::move(owner_of);
    }
    /// What the bodies and elastic joints hold now. Potential energy is measured from the origin.
    [[nodiscard]] HeldEnergy<double> held() const;

  protected:
    EnergyMeter() = default;
    ~EnergyMeter() = default;

    /// Energy that all rows of a joint took from the bodies since the meter was made [J].
    [[nodiscard]] double taken_by_address(const void* joint) const;

  private:
    // ---- what an engine answers

    virtual void list_bodies(std::vector<MeteredBody>& bodies) const = 0;
    virtual void list_plastic_joints(std::vector<MeteredPlasticJoint>& joints) const = 0;
    /// The engine is about to step: from now on it has to keep what the next two ask for.
    virtual void watch_step() = 0;
    virtual void list_joints(std::vector<MeteredJoint>& joints) const = 0;
    virtual void list_contacts(double dt, std::vector<MeteredContact>& contacts) const = 0;
    /// The step is booked.
    virtual void end_watch() {}
    /// Angular impulse that the engine adds for ω × Iω in a step of `dt` [s], from the body as its
    /// solver saw it [N m s].
    [[nodiscard]] virtual Vector3<double> gyroscopic_impulse(const MeteredBody& body,
                                                             double dt) const = 0;
    /// Takes away what the engine damps before it solves; `dt` [s].
    virtual void damp(MeteredBody& /*body*/, double /*dt*/) const {}

    /// A body over one step, in the frame in which the solver saw it.
    struct Course {
        MeteredBody start;                       ///< after damping
        double damped = 0;                       ///< [J]
        double ahead = 0;                        ///< booked by bodies_ahead [J]
        Vector3<double> velocity_after{0, 0, 0}; ///< after the solve, before a break's release
        Vector3<double> spin_after{0, 0, 0};
        Vector3<double> gyroscopic{0, 0, 0}; ///< beside the engine's own [N m s]
        bool asleep_after = false;
    };
    /// A plastic joint's totals at the start of the step [J].
    struct PlasticStart {
        double absorbed, damped, stored, released;
    };
    /// A step as it is booked.
    struct Record {
        AddressBook course_numbers, plastic_numbers;
        std::vector<Course> courses;
        std::vector<PlasticStart> plastic_start;
        PairAccounts::Accounts pairs;
        double dt = 0;
    };
    void swap_record() noexcept;
    void book_lists(double dt);
    void add(Account account, double energy) { ledger_.book(account, sign_ * energy); }

    [[nodiscard]] Course* course_of(const void* body);
    /// What hangs together by joints and contacts, and with a plastic joint.
    void find_islands();
    [[nodiscard]] std::size_t island_of(std::size_t course);
    [[nodiscard]] bool is_plastic(const void* body);
    /// Null where it is no plastic joint of the step.
    [[nodiscard]] const PlasticStart* start_of(const PairQueries* joint) const;
    void take_back(const void* body, const VelocityChange<double>& change);
    void undo_releases();
    void book_body(const Course& course, const MeteredBody& now, double dt);
    [[nodiscard]] double work(const void* body, const Vector3<double>& force,
                              const Vector3<double>& torque, double dt);
    void book_joint(const MeteredJoint& joint, double dt);
    void book_contact(MeteredContact& contact);
    /// What a pair took that nobody drives; `plastic`: with an account of its own.
    void book_pair(const PairAccounts::Pair& pair, bool plastic, double taken);
    /// Sum of the velocities before and after the step at a world point of the body [m/s].
    [[nodiscard]] Vector3<double> velocity_sum(const void* body, const Vector3<double>& point);

    /// What `keep` keeps.
    struct Kept {
        Ledger<double> ledger;
        HeldEnergy<double> last;
        std::vector<double> taken;
    };

    Kept kept_;
    Record record_;
    double sign_ = 1;     ///< -1: what is booked is taken back
    bool narrow_ = false; ///< the lists are of some of the bodies alone, and others were stepped
    PairAccounts pairs_;
    std::function<const void*(const void* body)> owner_of_;
    HeldEnergy<double> outside_; ///< by bodies that are not listed
    Ledger<double> ledger_;
    double step_plastic_ = 0, step_others_ = 0; ///< [J]
    HeldEnergy<double> last_;
    AddressBook course_numbers_, plastic_numbers_, taken_numbers_; ///< of the next three
    std::vector<Course> courses_;
    std::vector<PlasticStart> plastic_start_;
    std::vector<std::size_t> island_;         ///< by course: another one of its island, or itself
    std::vector<char> plastic_island_;        ///< by course that is its own
    std::vector<double> taken_;               ///< [J]
    mutable std::vector<MeteredBody> bodies_; ///< room that is used again, as are the next
    mutable std::vector<MeteredPlasticJoint> plastic_;
    std::vector<MeteredJoint> joints_;
    std::vector<MeteredContact> contacts_;
};

/// Does what bodies_rearranged books of `meter`, if there is one; of a change that tells whether it
/// was one, where it was. Returns that.
template <class Change>
bool rearrange(EnergyMeter* meter, const Change& change, Account account = Account::members) {
    const double before = meter != nullptr ? meter->held().total() : 0;
    if constexpr (std::is_void_v<decltype(change())>) {
        change();
    } else if (!change()) {
        return false;
    }
    if (meter != nullptr) meter->bodies_rearranged(before, account);
    return true;
}

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/world/energy_meter.ipp"
#endif
