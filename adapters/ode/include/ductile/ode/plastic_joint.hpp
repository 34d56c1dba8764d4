// SPDX-License-Identifier: MIT
//
// A plastic joint of six axes between two bodies of an ODE world: any mix of rigid, plastic and
// elastic-plastic axes, also with a shared yield surface. The rows, the finite rotation and the
// account are the core's Link; here they are handed to ODE and its answer is handed back.
//
//   ductile::ode::PlasticJoint root(world_id, beam, nullptr, {.origin = {0, 0, 0}, .axes = axes},
//                                   joint);
//   root.add_to(stepper);
//
// Rows. ODE has no joint with six bounded rows at a point, so two kinds of ODE's act together:
//   moments  an angular motor in user mode, its axes set anew in every step; it is id()
//   forces   rows at the joint's point, made for the step (point_rows.hpp), and so are the moments
//            where one of their rows is out of the direct solver's scale: the motor then rests
// A rigid row has infinite strength. Bounds that are not symmetric, as those of a coupled surface
// are, become a force from outside and a symmetric row (symmetric_row.hpp). All rows together act
// on both bodies at one point, so what one loses in momentum the other gains.
//
// Ties. Where rows repeat each other, as in a beam that is clamped at both ends, the direct solver
// would divide by zero. Every row therefore yields a little: by `softness` of the velocity that its
// own force gives to the two bodies in the step. That is below any certificate, and only shares
// forces out among rows that cannot be told apart.
//
// Rigid axes are pulled together by the world's ERP a step, as ODE's own joints are.
//
// Life in a world. The joint does nothing in a step in which ODE does not solve it: while both
// bodies sleep, while id() is disabled by the user, while neither body can move, and for ever after
// one of the bodies is destroyed. What its bodies do meanwhile, and what somebody moves by hand between
// two steps, is no deformation: the plastic axes keep their strain, their rest position goes along. Rigid
// axes are pulled together again. A broken joint stays broken; its angular motor is disabled, so
// the user may let the two bodies collide again.
//
// Bodies turn by ODE's first-order rule unless dBodySetFiniteRotationMode(body, 1) is set, which
// loses (ω dt)³/12 rad a step: set it where plastic rotations per step are large.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "ductile/joint/joint_axis.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/ode/convert.hpp"
#include "ductile/ode/plastic_constraint.hpp"
#include "ductile/ode/point_rows.hpp"
#include "ductile/ode/symmetric_row.hpp"
#include "ductile/ode/world.hpp"

namespace ductile::ode {

/// Place and velocities of a body as a link sees it, without its mass; null: the static world.
[[nodiscard]] inline BodyState<double> body_motion(dBodyID body) noexcept {
    if (body == nullptr) return {};
    return {.position = to_core(dBodyGetPosition(body)),
            .orientation = matrix_to_core(dBodyGetRotation(body)),
            .velocity = linear_velocity(body),
            .spin = angular_velocity(body)};
}

/// The body as a link sees it. A kinematic body moves but cannot be moved.
[[nodiscard]] inline BodyState<double> body_state(dBodyID body) noexcept {
    BodyState<double> result = body_motion(body);
    if (body == nullptr || dBodyIsKinematic(body)) return result;
    dMass m;
    dBodyGetMass(body, &m);
    result.inverse_mass = 1 / double(m.mass);
    const Matrix3<double> turned = result.orientation * matrix_to_core(m.I).inverse();
    result.inverse_inertia = turned * result.orientation.transpose();
    return result;
}

/// A frame given in the world, in the axes of a body (null: the static world), from its centre.
[[nodiscard]] inline JointFrame<double> frame_in(dBodyID body, const JointFrame<double>& world) {
    const BodyState<double> at = body_motion(body);
    return {.origin = at.orientation.transpose() * (world.origin - at.position),
            .axes = at.orientation.transpose() * world.axes};
}

/// Number of axes that a joint rules; asked of what is no joint, too, while a constructor's
/// arguments are sorted out.
template <class Joint>
inline constexpr std::size_t ruled_axes = [] {
    if constexpr (requires { Joint::dimension; }) {
        return std::size_t(Joint::dimension);
    } else {
        return std::size_t(1);
    }
}();

/// Joint: OneAxisJoint, or CoupledJoint of up to six axes.
template <class Joint>
class PlasticJoint final : public PlasticConstraint {
  public:
    using Axes = std::array<JointAxis, ruled_axes<Joint>>;
    using State = typename Link<Joint>::State;
    using Frame = JointFrame<double>;

    /// The axes of a joint that rules them all.
    [[nodiscard]] static constexpr Axes every_axis() {
        static_assert(ruled_axes<Joint> == 6,
                      "PlasticJoint: say which axes are plastic; the others are rigid");
        return all_joint_axes;
    }

    /// The plastic axes start unstrained where the bodies are now. `in_a`, `in_b`: the joint's
    /// frame in body A and in body B (null: the static world), z along the member; `axes`: which
    /// axis each row of `joint` is.
    /// @throws std::invalid_argument where A is null, both bodies are one, a frame is not finite or
    /// not orthonormal and right-handed, or an axis is given twice.
    PlasticJoint(dWorldID world, dBodyID a, dBodyID b, const Frame& in_a, const Frame& in_b,
                 Joint joint, const std::array<JointAxis, ruled_axes<Joint>>& axes = every_axis())
        : a_(require_bodies(a, b)),
          b_(b),
          link_(std::move(joint), axes, require_frame("in_a", in_a), require_frame("in_b", in_b)),
          forces_(world),
          id_(dJointCreateAMotor(world, nullptr)) {
        dJointAttach(id_, a_, b_);
        dJointSetAMotorNumAxes(id_, 3);
        dJointSetFeedback(id_, &moments_);
        link_.start(body_motion(a_), body_motion(b_));
    }

    /// As above with one frame, in the world, where the bodies are now.
    PlasticJoint(dWorldID world, dBodyID a, dBodyID b, const Frame& in_world, Joint joint,
                 const std::array<JointAxis, ruled_axes<Joint>>& axes = every_axis())
        : PlasticJoint(world, require_bodies(a, b), b,
                       frame_in(a, require_frame("in_world", in_world)), frame_in(b, in_world),
                       std::move(joint), axes) {}

    PlasticJoint(const PlasticJoint&) = delete;
    PlasticJoint& operator=(const PlasticJoint&) = delete;
    ~PlasticJoint() override { dJointDestroy(id_); }

    void add_to(World& world, std::string name = {}) { world.add(*this, std::move(name)); }
    void remove_from(World& world) { world.remove(*this); }

    /// Reaction on A along +axis of frame B in the last step, whether rigid or plastic [N | N m].
    /// While the bodies sleep that of the step before; zero while the joint does not act.
    [[nodiscard]] double force(JointAxis axis) const { return silent_ ? 0 : link_.force(axis); }
    /// Position of A in frame B; rotation angles go on over many turns; of a rigid axis what it is
    /// off by [m | rad].
    [[nodiscard]] double position(JointAxis axis) const { return link_.position(axis); }
    /// Rest position q_p; zero for a rigid axis [m | rad].
    [[nodiscard]] double plastic_offset(JointAxis axis) const { return link_.plastic_offset(axis); }
    /// Accumulated plastic travel p, equivalent, never decreases [m | rad of the law].
    [[nodiscard]] double plastic_travel() const { return joint().state().plastic_travel; }
    /// Energy dissipated by plastic flow [J].
    [[nodiscard]] double absorbed_energy() const override { return joint().state().plastic_work; }
    [[nodiscard]] double stored_energy() const override { return joint().state().stored; }
    /// How near the last step's forces are to yield: 1 where the joint flows [-].
    [[nodiscard]] double utilisation() const {
        if (silent_) return 0;
        if constexpr (requires { joint().utilisation(); }) {
            return joint().utilisation();
        } else {
            const double f = link_.force(link_.axes()[0]);
            return std::abs(f) / joint().strength(f < 0 ? -1 : 1);
        }
    }
    [[nodiscard]] bool broken() const { return link_.broken(); }
    /// Unreliable where the solver left a row unsolved, plastic or rigid.
    [[nodiscard]] Outcome outcome() const { return broken() ? Outcome::broken : link_.outcome(); }
    /// Certificate: violation of the plastic rows in the last step, and the largest so far
    /// [m/s | rad/s].
    [[nodiscard]] double residual() const { return link_.last().residual; }
    [[nodiscard]] double residual_max() const { return joint().state().residual_max; }
    /// Largest violation of the rigid rows in the last step [m/s | rad/s].
    [[nodiscard]] double rigid_residual() const { return link_.rigid_residual(); }
    [[nodiscard]] JointReport<double> report() const override {
        if (!detached() && dJointIsEnabled(id_) != 0) {
            return link_report(link_, link_.velocities(body_motion(a_), body_motion(b_)));
        }
        return link_report(link_, Vector6<double>(Vector6<double>::Zero()));
    }
    /// True where one of the bodies was destroyed: the joint does nothing any more.
    [[nodiscard]] bool detached() const {
        return dJointGetBody(id_, 0) != a_ || dJointGetBody(id_, 1) != b_;
    }

    [[nodiscard]] const Joint& joint() const { return link_.joint(); }
    [[nodiscard]] const Link<Joint>& link() const { return link_; }
    [[nodiscard]] const BreakRelease<double>& release() const override { return release_; }
    /// All but what the angular motor did.
    [[nodiscard]] const OutsideForce& outside_force() const override { return outside_; }
    /// The angular motor; owned by this object, as is its feedback.
    [[nodiscard]] dJointID id() const override { return id_; }

    [[nodiscard]] State state() const { return link_.state(); }
    /// Goes on from a saved state; the bodies have to be put back too.
    void restore(const State& state) {
        link_.restore(state);
        put_back_ = true;
        silent_ = broken();
        broken() ? dJointDisable(id_) : dJointEnable(id_);
    }

    /// Sets the rows for a step of `dt` [s]. Called by World::step.
    void prepare(double dt) override {
        acting_ = false;
        outside_ = {};
        if (broken() || !may_act()) {
            if (!broken()) link_.pause();
            silent_ = true;
            return;
        }
        acting_ = true;
        const BodyState<double> a = body_state(a_), b = body_state(b_);
        if (!put_back_) link_.teleport(a, b);
        put_back_ = false;
        const double rate = double(dWorldGetERP(dBodyGetWorld(a_))) / dt;
        link_.prepare(a, b, force_share_.value * dt, rate, force_share_.midway);
        arm_a_ = link_.point() - a.position;
        arm_b_ = link_.point() - b.position;
        centre_ = {};
        std::array<PointRow, 3> force_rows, moment_rows;
        bool out_of_scale = false; // a moment's row
        for (const JointAxis axis : all_joint_axes) {
            const LinkRow<double> row = link_.row(axis);
            SymmetricRow symmetric = symmetric_row(row.limits, dt, force_share_.value);
            const double moved = mobility(a, arm_a_, row) + mobility(b, arm_b_, row);
            symmetric.cfm += softness * dt * moved;
            (row.turns ? centre_.moment : centre_.force) += symmetric.centre * row.direction;
            const double scale = row_scale(moved + symmetric.cfm / dt);
            out_of_scale = out_of_scale || (row.turns && scale != 1);
            (row.turns ? moment_rows : force_rows)[index(axis) % 3] = {row.direction, symmetric,
                                                                       scale};
        }
        forces_.make(a_, b_, link_.point(), force_rows);
        for (int i = 0; i < 3; ++i) set_motor(i, moment_rows[std::size_t(i)], !out_of_scale);
        if (out_of_scale) forces_.make_moments(a_, b_, moment_rows);
        moments_ = {}; // ODE leaves it alone where the motor has no row
        add_centre(1);
    }

    /// Books the step; after a break lets go. Called by World::step.
    void commit(double dt) override {
        if (!acting_) return;
        if (!solved()) {
            // ODE keeps what was applied for the step
            add_centre(-1);
            forces_.clear();
            link_.pause();
            return;
        }
        silent_ = false;
        outside_ = forces_.collect();
        outside_.force += centre_.force;
        outside_.torque_a += arm_a_.cross(centre_.force) + centre_.moment;
        outside_.torque_b -= arm_b_.cross(centre_.force) + centre_.moment;
        const Vector3<double> torque = outside_.torque_a + to_core(moments_.t1);
        link_.commit(
            body_motion(a_), body_motion(b_),
            JointWrench<double>{.force = outside_.force / force_share_.value,
                                .moment = (torque - arm_a_.cross(outside_.force)) / force_share_.value},
            force_share_.value * dt);
        if (broken()) let_go();
    }

  private:
    /// Share of its own effect by which a row yields [-]. Ties between repeated rows are then
    /// solved to some 1e-4 of the force, and single rows are off by this share.
    static constexpr double softness = 1e-12;

    static dBodyID require_bodies(dBodyID a, dBodyID b) {
        require_body("PlasticJoint", a);
        if (a == b) throw std::invalid_argument("PlasticJoint.b: must not be body a itself");
        return a;
    }
    static const Frame& require_frame(const char* name, const Frame& frame) {
        constexpr double round_off = 1e-9;
        const std::string field = std::string("PlasticJoint.") + name;
        if (!frame.origin.allFinite()) {
            throw std::invalid_argument(field + ".origin: must be finite [m]");
        }
        const bool orthonormal = (frame.axes.transpose() * frame.axes).isIdentity(round_off) &&
                                 frame.axes.determinant() > 0;
        if (!orthonormal) {
            throw std::invalid_argument(field +
                                        ".axes: must be three orthonormal columns, right-handed");
        }
        return frame;
    }

    static bool can_move(dBodyID body) { return body != nullptr && !dBodyIsKinematic(body); }
    [[nodiscard]] bool may_act() const {
        return !detached() && dJointIsEnabled(id_) != 0 && (can_move(a_) || can_move(b_));
    }
    /// True where ODE did solve the rows: it wakes whatever hangs on a body that is awake.
    [[nodiscard]] bool solved() const {
        return dBodyIsEnabled(a_) != 0 || (b_ != nullptr && dBodyIsEnabled(b_) != 0);
    }

    /// Velocity of the row that a unit impulse of its own gives to one body [1/kg | 1/(kg m²)].
    static double mobility(const BodyState<double>& body, const Vector3<double>& arm,
                           const LinkRow<double>& row) {
        const Vector3<double> turn =
            row.turns ? row.direction : Vector3<double>(arm.cross(row.direction));
        return (row.turns ? 0 : body.inverse_mass) + turn.dot(body.inverse_inertia * turn);
    }

    void set_motor(int number, const PointRow& moment, bool on) {
        constexpr int in_world = 0;
        const Vector3<double>& axis = moment.direction;
        dJointSetAMotorAxis(id_, number, in_world, dReal(axis.x()), dReal(axis.y()),
                            dReal(axis.z()));
        const int group = dParamGroup * number;
        dJointSetAMotorParam(id_, dParamFMax + group, dReal(on ? moment.row.strength : 0));
        dJointSetAMotorParam(id_, dParamVel + group, dReal(moment.row.velocity));
        dJointSetAMotorParam(id_, dParamCFM + group, dReal(moment.row.cfm));
    }

    /// The centres of the rows' bounds as an outside force on both bodies.
    void add_centre(double sign) {
        const Vector3<double> force = sign * centre_.force, moment = sign * centre_.moment;
        add(a_, force, arm_a_.cross(force) + moment);
        if (b_ != nullptr) add(b_, -force, -arm_b_.cross(force) - moment);
    }
    static void add(dBodyID body, const Vector3<double>& force, const Vector3<double>& torque) {
        dBodyAddForce(body, dReal(force.x()), dReal(force.y()), dReal(force.z()));
        dBodyAddTorque(body, dReal(torque.x()), dReal(torque.y()), dReal(torque.z()));
    }

    void let_go() {
        dJointDisable(id_);
        release_ = link_.release(body_state(a_), body_state(b_));
        if (can_move(a_)) apply(a_, release_.a);
        if (can_move(b_)) apply(b_, release_.b);
    }

    dBodyID a_;
    dBodyID b_;
    Link<Joint> link_;
    PointRows forces_;
    dJointID id_;
    dJointFeedback moments_{};
    Vector3<double> arm_a_ = Vector3<double>::Zero(); ///< joint minus centre of mass, world [m]
    Vector3<double> arm_b_ = Vector3<double>::Zero();
    JointWrench<double> centre_; ///< c of all rows
    OutsideForce outside_;
    BreakRelease<double> release_;
    bool put_back_ = false; ///< a saved state, with which the bodies move back
    bool acting_ = false; ///< between prepare and commit: the joint takes part in this step
    bool silent_ = true;  ///< no force
};

} // namespace ductile::ode
