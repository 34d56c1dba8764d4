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
//   worst
//     there is: chains of three and more hinges need a direct one. See multibody_solver.hpp. The
//     matrix of a chain has a condition of N⁴: in single precision Dantzig's method pivots wrongly
//     now and then from about ten hinges, which the certificate reports; build Bullet double.
//   - Islands are solved together until they have m_minimumSolverBatchSize (128) constraints: with
//   a
//     direct solver set it to 1, as its cost grows with the third power.
//   - A ball link turns by at most π/4 a step; faster spins than that are cut by Bullet.
//   - Fixed joints between links must be setupFixed; links of a btMultiBody never carry rigid rows.
//
// Not thread-safe beyond what Bullet guarantees for a constraint.
#pragma once

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "ductile/bullet/convert.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/row.hpp"
#include "ductile/world/joint_report.hpp"

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
class MultiBodyPlasticConstraint : protected btMultiBodyConstraint {
  public:
    BT_DECLARE_ALIGNED_ALLOCATOR();

    MultiBodyPlasticConstraint(const MultiBodyPlasticConstraint&) = delete;
    MultiBodyPlasticConstraint& operator=(const MultiBodyPlasticConstraint&) = delete;
    ~MultiBodyPlasticConstraint() override = default;

    /// Adds the constraint and its end-of-tick commit to a world. The multibody and its colliders
    /// must be in the world.
    /// @throws std::invalid_argument where Bullet would never solve it.
    void add_to(btMultiBodyDynamicsWorld& world) {
        if (collider() == nullptr) {
            throw std::invalid_argument(
                "MultiBodyPlasticConstraint.body: must have a collider that is not static, or "
                "Bullet never solves its joints");
        }
        if (!world.getSimulationIslandManager()->getSplitIslands()) {
            throw std::invalid_argument(
                "MultiBodyPlasticConstraint.world: must split islands, or Bullet never solves the "
                "joints of multibodies");
        }
        world.addMultiBodyConstraint(this);
        world.addAction(&action_);
        world_ = &world;
    }
    void remove_from(btMultiBodyDynamicsWorld& world) {
        world.removeAction(&action_);
        world.removeAction(&release_action_);
        world.removeMultiBodyConstraint(this);
        world_ = nullptr;
        phase_ = Phase::idle;
    }

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
                               btMultibodyLink::eFeatherstoneJointType type, const char* wanted)
        // arguments are evaluated in any order: none may read a link that is not there
        : btMultiBodyConstraint(&body, &body, link,
                                body.getLink(checked(body, link, type, wanted)).m_parent, rows,
                                true, MAX_MULTIBODY_CONSTRAINT_TYPE) {}

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

    /// True where Bullet left the rows out of its last tick although the multibody was awake.
    [[nodiscard]] bool left_out() const noexcept { return left_out_; }

    template <class Joint, class JointStep>
    [[nodiscard]] JointReport<double> report_of(const Joint& joint, const JointStep& last,
                                                Outcome outcome) const noexcept {
        auto now =
            joint_report<double>(joint.state(), last, joint.fracture(), outcome, 0.0);
        if (!broken()) now.rotation_rate = velocity().cwiseAbs().maxCoeff();
        return asleep() ? idle_report(now) : now;
    }

    /// Gives energy >= 0 [J] to the motion along `direction` of the link's degrees of freedom when
    /// all joints of the world have committed the tick.
    void hand_back(double energy, const Values& direction) {
        release_.energy = energy;
        release_direction_ = direction;
        // Bullet calls actions in the order they were added, also those added meanwhile
        if (world_ != nullptr) world_->addAction(&release_action_);
    }

  private:
    /// idle -> watched: u is known -> asked: rows are with the solver -> idle
    enum class Phase { idle, watched, asked };

    struct CommitAction final : btActionInterface {
        explicit CommitAction(MultiBodyPlasticConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override { owner_.settle(); }
        void debugDraw(btIDebugDraw*) override {}
        MultiBodyPlasticConstraint& owner_;
    };

    /// Hands back once.
    struct ReleaseAction final : btActionInterface {
        explicit ReleaseAction(MultiBodyPlasticConstraint& owner) : owner_(owner) {}
        void updateAction(btCollisionWorld*, btScalar) override {
            if (owner_.release_.impulse.isZero(0)) owner_.apply_release();
        }
        void debugDraw(btIDebugDraw*) override {}
        MultiBodyPlasticConstraint& owner_;
    };

    /// Faster than any joint: a row that wants it ends at its bound.
    static constexpr double out_of_reach = 1e6;

    static int checked(const btMultiBody& body, int link,
                       btMultibodyLink::eFeatherstoneJointType type, const char* wanted) {
        if (link < 0 || link >= body.getNumLinks() || body.getLink(link).m_jointType != type) {
            check::fail("MultiBodyPlasticConstraint.link", double(link), "", wanted);
        }
        return link;
    }

    /// Index of the row's degree of freedom in Bullet's velocity vector.
    [[nodiscard]] int column(int row) const noexcept {
        return 6 + m_bodyA->getLink(m_linkA).m_dofOffset + row;
    }
    [[nodiscard]] Values velocity() const noexcept {
        Values u = Values::Zero();
        for (int i = 0; i < m_numRows; ++i) u[i] = double(m_bodyA->getJointVelMultiDof(m_linkA)[i]);
        return u;
    }

    /// By whose island the rows are found: nearest towards the base, else any.
    [[nodiscard]] const btMultiBodyLinkCollider* collider() const noexcept {
        const auto moves = [](const btMultiBodyLinkCollider* c) {
            return c != nullptr && !c->isStaticOrKinematicObject();
        };
        for (int i = m_linkA; i >= 0; i = m_bodyA->getLink(i).m_parent) {
            if (moves(m_bodyA->getLink(i).m_collider)) return m_bodyA->getLink(i).m_collider;
        }
        for (int i = 0; i < m_bodyA->getNumLinks(); ++i) {
            if (moves(m_bodyA->getLink(i).m_collider)) return m_bodyA->getLink(i).m_collider;
        }
        return moves(m_bodyA->getBaseCollider()) ? m_bodyA->getBaseCollider() : nullptr;
    }

    // ---- Bullet's side
    // ---------------------------------------------------------------------------
    void finalizeMultiDof() override {
        allocateJacobiansMultiDof();
        for (int i = 0; i < m_data.size(); ++i) m_data[i] = 0;
        for (int i = 0; i < m_numRows; ++i) jacobianA(i)[column(i)] = 1;
        m_numDofsFinalized = m_jacSizeBoth;
    }

    /// Bullet asks first while it makes islands, before this tick's forces change the velocities.
    int getIslandIdA() const override {
        if (phase_ == Phase::idle) {
            tick_.velocity = velocity();
            phase_ = Phase::watched;
        }
        const btMultiBodyLinkCollider* c = collider();
        return c != nullptr ? c->getIslandTag() : -1;
    }
    int getIslandIdB() const override { return getIslandIdA(); }
    void debugDraw(btIDebugDraw*) override {}

    void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                              const btContactSolverInfo& info) override {
        if (m_jacSizeA != 6 + m_bodyA->getNumDofs()) finalizeMultiDof();
        phase_ = Phase::asked;
        if (broken()) return;
        const int first = rows.size();
        for (int i = 0; i < m_numRows; ++i) open_row(rows.expandNonInitializing(), i, data, info);
        response_.setIdentity();
        for (int i = 0; i < m_numRows; ++i) {
            const btScalar* answer =
                &data.m_deltaVelocitiesUnitImpulse[rows[first + i].m_jacAindex + column(0)];
            for (int j = 0; j < m_numRows; ++j) response_(j, i) = double(answer[j]);
        }
        tick_.response = response_;
        tick_.dt = double(info.m_timeStep);
        std::array<RowLimits<double>, 3> limits;
        prepare(tick_, std::span(limits).first(std::size_t(m_numRows)));
        for (int i = 0; i < m_numRows; ++i) close_row(rows[first + i], limits[std::size_t(i)]);
    }

    /// Jacobian, response and free velocity, by Bullet's own means.
    void open_row(btMultiBodySolverConstraint& row, int i, btMultiBodyJacobianData& data,
                  const btContactSolverInfo& info) {
        const btVector3 none(0, 0, 0);
        const btMultibodyLink& link = m_bodyA->getLink(m_linkA);
        // the world axis is for Bullet's joint feedback only
        const btVector3 axis = link.m_cachedWorldTransform.getBasis() * link.getAxisTop(i);
        fillMultiBodyConstraint(row, data, jacobianA(i), jacobianB(i), axis, none, none, none, 0,
                                info, 0, 0, true);
        row.m_orgConstraint = this;
        row.m_orgDofIndex = i;
        row.m_solverBodyIdA = row.m_solverBodyIdB = -1;
    }

    /// The row  (A + C) λ = b - u_free  inside its bounds. A force that is given, lower = upper, is
    /// asked for as a bound that the row cannot but reach, because Dantzig's method wants 0 inside
    /// them.
    void close_row(btMultiBodySolverConstraint& row,
                   const RowLimits<double>& limits) const noexcept {
        if (!(row.m_jacDiagABInv > 0)) return;
        const double response = 1 / double(row.m_jacDiagABInv);
        const double free_velocity = -double(row.m_rhs) * response;
        const double stiff = response + limits.compliance;
        const bool given = limits.lower == limits.upper;
        const double target = given ? std::copysign(out_of_reach, limits.upper) : limits.bias;
        const double lower = given ? std::min(limits.lower, 0.0) : limits.lower;
        const double upper = given ? std::max(limits.upper, 0.0) : limits.upper;
        row.m_jacDiagABInv = btScalar(1 / stiff);
        row.m_rhs = btScalar((target - free_velocity) / stiff);
        row.m_cfm = btScalar(limits.compliance / stiff);
        row.m_lowerLimit = btScalar(lower * tick_.dt);
        row.m_upperLimit = btScalar(upper * tick_.dt);
    }

    /// End of the tick.
    void settle() {
        const Phase was = phase_;
        phase_ = Phase::idle;
        left_out_ = was == Phase::watched && !asleep();
        if (was != Phase::asked || broken()) return;
        Values force = Values::Zero();
        for (int i = 0; i < m_numRows; ++i) force[i] = double(getAppliedImpulse(i)) / tick_.dt;
        commit(force, velocity(), tick_.dt);
    }

    /// The impulse h Δu with h = (J M⁻¹ Jᵀ)⁻¹ e along e; see ductile::release_impulse. Its work is
    /// impulse · (u + u')/2.
    void apply_release() {
        const Values along = release_direction_.normalized();
        const Values held = numeric::inverse(response_) * along; // zero for rows that are not there
        const double mass = along.dot(held);
        const double momentum = held.dot(velocity());
        const double root = std::sqrt(momentum * momentum + 2 * mass * release_.energy);
        if (!(mass > 0) || !std::isfinite(mass) || !(root > 0)) return;
        release_.impulse =
            held * std::copysign(2 * release_.energy / (std::abs(momentum) + root), momentum);

        const auto size = std::size_t(m_jacSizeA);
        std::vector<btScalar> impulse(size, 0), change(size, 0);
        for (int i = 0; i < m_numRows; ++i) {
            impulse[std::size_t(column(i))] = btScalar(release_.impulse[i]);
        }
        btAlignedObjectArray<btScalar> scratch;
        btAlignedObjectArray<btVector3> scratch_vectors;
        // with the articulated inertias of this tick, as the solver had them
        m_bodyA->calcAccelerationDeltasMultiDof(impulse.data(), change.data(), scratch,
                                                scratch_vectors);
        m_bodyA->applyDeltaVeeMultiDof(change.data(), 1);
    }

    [[nodiscard]] bool asleep() const noexcept {
        const btMultiBodyLinkCollider* c = collider();
        return c != nullptr && c->getActivationState() == ISLAND_SLEEPING;
    }

    CommitAction action_{*this};
    ReleaseAction release_action_{*this};
    btMultiBodyDynamicsWorld* world_ = nullptr;
    mutable Tick tick_{Values::Zero(), Matrix3<double>::Identity(), 0};
    mutable Phase phase_ = Phase::idle;
    Matrix3<double> response_ = Matrix3<double>::Identity();
    MultiBodyRelease release_;
    Values release_direction_ = Values::UnitX();
    bool left_out_ = false;
};

} // namespace ductile::bullet
