// SPDX-License-Identifier: MIT
//
// Plastic joints in reduced coordinates: what MultiBodyPlasticHinge and MultiBodyPlasticBall share.
// A link of a btMultiBody has no rigid rows to solve, only the plastic ones, so a chain of N hinges
// is N rows that a direct solver answers exactly. It translates rows and reactions; the plasticity
// is the core's joint.
//
// Each row is one degree of freedom of the link: velocity u of the link relative to its parent,
// moment positive where it turns the link. u at the start of a tick is read before Bullet adds this
// tick's forces, when it asks for the constraint's island; forces, velocities and positions at its
// end are read by an action that `add_to` registers. Results are those of the last whole tick.
//
// Break. A multibody cannot be cut: the rows are dropped for good and the link goes on as a free
// hinge or ball. The energy that the breaking step took in excess is handed back along its degrees
// of freedom; the other joints of the multibody feel that as a kick, to be met in the next tick.
//
// Traps of Bullet 3.24
//   - Bullet finds the rows of a multibody by the islands of its colliders. Without a collider that
//     is not static, or with setSplitIslands(false), they are silently never solved. `add_to`
//     refuses such a multibody or world, and a joint whose rows were left out is `unreliable`.
//   - Defaults of btMultiBody: linear and angular damping 0.04 (and as much again times the speed),
//     joint speeds cut at 100 rad/s or m/s, sleep after 2 s below 0.22 rad/s. See `undamp`.
//     (setMaxAppliedImpulse is not used by anything.)
//   - Solvers. The iterative one sees every joint alone with all others of the chain free, the
//     worst there is: chains of three and more hinges need a direct one. See multibody_solver.hpp.
//     The matrix of a chain has a condition of N⁴: in single precision Dantzig's method pivots
//     wrongly now and then from about ten hinges, which the certificate reports; build Bullet
//     double.
//   - Islands are solved together until they have m_minimumSolverBatchSize (128) constraints: with
//     a direct solver set it to 1, as its cost grows with the third power.
//   - A ball link turns by at most π/4 a step; faster spins than that are cut by Bullet.
//   - Fixed joints between links must be setupFixed; links of a btMultiBody never carry rigid rows.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <limits>
#include <span>

#include "ductile/bullet/tick_account.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/vocabulary/row.hpp"
#include "ductile/vocabulary/vector.hpp"
#include "ductile/world/joint_report.hpp"
#include "ductile/world/kept_joint.hpp"

namespace ductile::bullet {

/// Takes away what Bullet does to a multibody unasked: damping and the limit of joint speeds.
inline void undamp(btMultiBody& body) {
    body.setLinearDamping(0);
    body.setAngularDamping(0);
    body.setMaxCoordinateVelocity(std::numeric_limits<btScalar>::max());
}

/// What a break handed back, once, at the end of the breaking tick.
struct MultiBodyRelease {
    double energy = 0;                                 ///< [J]; zero: nothing was handed back
    Vector3<double> impulse = Vector3<double>::Zero(); ///< by degree of freedom of the link [N m s]
};

/// Base is protected so that nobody adds the constraint to a world without its action.
class MultiBodyPlasticConstraint : protected btMultiBodyConstraint,
                                   public KeptJoint,
                                   public TickMember {
  public:
    BT_DECLARE_ALIGNED_ALLOCATOR();

    DUCTILE_INLINE ~MultiBodyPlasticConstraint() override;

    /// Adds the constraint and its end-of-tick commit to a world, which has to outlive it: one that
    /// ends leaves its world. The multibody and its colliders must be in the world.
    /// @throws std::invalid_argument where Bullet would never solve it, or it is in a world
    /// already.
    void add_to(btMultiBodyDynamicsWorld& world);
    void remove_from(btMultiBodyDynamicsWorld& world);

    [[nodiscard]] btMultiBody& body() const noexcept { return *m_bodyA; }
    [[nodiscard]] int link() const noexcept { return m_linkA; }

    [[nodiscard]] virtual double absorbed_energy() const noexcept = 0; ///< D [J]
    [[nodiscard]] virtual bool broken() const noexcept = 0;
    [[nodiscard]] const MultiBodyRelease& release() const noexcept { return release_; }
    /// Of the last whole tick, an idle one where the multibody slept. Speeds are those of now.
    [[nodiscard]] virtual JointReport<double> report() const noexcept = 0;
    /// True from add_to to remove_from.
    [[nodiscard]] bool in_world() const noexcept { return world_ != nullptr; }

  protected:
    using Values = Vector3<double>; ///< one entry per row, the rest zero

    /// @throws std::invalid_argument where the multibody has no such link or that has not `rows`
    /// degrees of freedom of the type.
    MultiBodyPlasticConstraint(btMultiBody& body, int link, int rows,
                               btMultibodyLink::eFeatherstoneJointType type, const char* wanted);

    /// What the rows are given at the start of a tick.
    struct Tick {
        Values velocity;          ///< u, before this tick's forces [rad/s]
        Matrix3<double> response; ///< velocity per unit impulse, J M⁻¹ Jᵀ [1/(kg m²)]
        double dt;                ///< [s]
    };
    /// Rules the rows.
    virtual void prepare(const Tick& tick, std::span<RowLimits<double>> limits) = 0;
    /// Books the tick; `force` λ/dt [N m], `velocity` u' [rad/s].
    virtual void commit(const Values& force, const Values& velocity, double dt) = 0;
    /// The tick that was booked last broke the joint.
    virtual void let_go() = 0;
    [[nodiscard]] virtual const Step<double>& last() const noexcept = 0;

    /// True where Bullet left the rows out of its last tick although the multibody was awake.
    [[nodiscard]] bool left_out() const noexcept { return left_out_; }

    template <class Joint, class JointStep>
    [[nodiscard]] JointReport<double> report_of(const Joint& joint, const JointStep& last,
                                                Outcome outcome) const noexcept {
        const auto now = joint_report<double>(joint.state(), last, joint.fracture(), outcome, 0.0);
        return asleep() ? idle_report(now) : now;
    }

    /// Gives energy >= 0 [J] to the motion along `direction` of the link's degrees of freedom when
    /// all joints of the world have committed the tick.
    void hand_back(double energy, const Values& direction);

  private:
    /// idle -> watched: u is known -> asked: rows are with the solver -> idle
    enum class Phase { idle, watched, asked };

    struct CommitAction final : btActionInterface {
        explicit CommitAction(MultiBodyPlasticConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override { owner_.end_tick_of_world(); }
        void debugDraw(btIDebugDraw*) override {}
        MultiBodyPlasticConstraint& owner_;
    };

    /// Hands back once.
    struct ReleaseAction final : btActionInterface {
        explicit ReleaseAction(MultiBodyPlasticConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override {
            if (is_zero(owner_.release_.impulse)) owner_.apply_release();
        }
        void debugDraw(btIDebugDraw*) override {}
        MultiBodyPlasticConstraint& owner_;
    };

    static int checked(const btMultiBody& body, int link,
                       btMultibodyLink::eFeatherstoneJointType type, const char* wanted);

    /// Index of the row's degree of freedom in Bullet's velocity vector.
    [[nodiscard]] int column(int row) const noexcept {
        return 6 + m_bodyA->getLink(m_linkA).m_dofOffset + row;
    }
    [[nodiscard]] Values velocity() const noexcept;

    /// By whose island the rows are found: nearest towards the base, else any.
    [[nodiscard]] const btMultiBodyLinkCollider* collider() const noexcept;

    // ---- Bullet's side

    DUCTILE_INLINE void finalizeMultiDof() override;
    /// Bullet asks first while it makes islands, before this tick's forces change the velocities.
    DUCTILE_INLINE int getIslandIdA() const override;
    int getIslandIdB() const override { return getIslandIdA(); }
    void debugDraw(btIDebugDraw*) override {}
    DUCTILE_INLINE void createConstraintRows(btMultiBodyConstraintArray& rows,
                                             btMultiBodyJacobianData& data,
                                             const btContactSolverInfo& info) override;

    /// Jacobian, response and free velocity, by Bullet's own means.
    void open_row(btMultiBodySolverConstraint& row, int i, btMultiBodyJacobianData& data,
                  const btContactSolverInfo& info);
    /// The row  (A + C) λ = b - u_free  inside its bounds. A force that is given, lower = upper, is
    /// asked for as a bound that the row cannot but reach, because Dantzig's method wants 0 inside
    /// them.
    void close_row(btMultiBodySolverConstraint& row,
                   const RowLimits<double>& limits) const noexcept;
    DUCTILE_INLINE void end_tick() override;
    DUCTILE_INLINE void finish_tick() override;
    [[nodiscard]] DUCTILE_INLINE std::size_t island() const override;
    [[nodiscard]] const Step<double>* booked() const noexcept override {
        return unfinished_ ? &last() : nullptr;
    }
    /// The impulse h Δu with h = (J M⁻¹ Jᵀ)⁻¹ e along e; see ductile::release_impulse. Its work is
    /// impulse · (u + u')/2.
    void apply_release();
    [[nodiscard]] bool asleep() const noexcept;

    CommitAction action_{*this};
    ReleaseAction release_action_{*this};
    btMultiBodyDynamicsWorld* world_ = nullptr;
    mutable Tick tick_{Values::Zero(), Matrix3<double>::Identity(), 0};
    mutable Phase phase_ = Phase::idle;
    Matrix3<double> response_ = Matrix3<double>::Identity();
    MultiBodyRelease release_;
    Values release_direction_{1, 0, 0};
    bool left_out_ = false;
    bool unfinished_ = false; ///< booked, that is
};

} // namespace ductile::bullet

#ifndef DUCTILE_COMPILED
#include "ductile/bullet/multibody_constraint.ipp"
#endif
