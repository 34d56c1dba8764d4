// SPDX-License-Identifier: MIT
//
// The Charpy test in ODE. Contact joints are made from the points of edge_contact.hpp; one that is
// still apart gets a target velocity that lets it close the gap in this step and no more, one that
// rebounds the velocity at which it parts. Bodies do not collide otherwise.
//
// The specimen is weightless until struck: it stands for one that rests on a shelf. In the 5 ms of
// the blow gravity would move it by 0.1 mm.
//
// ODE's joints neither break by themselves nor have Bullet's second kind of spring. zero-limits is
// here what its users do: a hinge stopped at zero, whose feedback is read after the step and which
// is disabled beyond the threshold. spring2 is a motor with the spring's force, the spring
// softened as Bullet's: so that it turns by a quarter radian of its phase a step.
#pragma once

#include <ode/ode.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/ode/energy_meter.hpp"
#include "ductile/ode/ode.hpp"
#include "edge_contact.hpp"
#include "simulation.hpp"
#include "specimen_joints.hpp"

namespace charpy {

class OdeScene {
    using Joints = SpecimenJoints<ductile::ode::PlasticHinge, ductile::ode::PlasticJoint>;

  public:
    static constexpr std::string_view engine = "ode";
    static constexpr std::string_view precision =
        sizeof(dReal) == sizeof(double) ? "double" : "float";

    OdeScene(const Scenario& scenario, Method method, const std::string& solver)
        : s_(scenario), method_(method) {
        if (solver != "direct" && solver != "quick") {
            throw std::invalid_argument("--solver = " + solver + ": must be " +
                                        std::string(ode_solvers) + " with --engine ode");
        }
        ductile::ode::WorldParameters parameters{.solver = solver == "direct"
                                                               ? ductile::ode::Solver::direct
                                                               : ductile::ode::Solver::quick,
                                                 .warn = nullptr};
        if (is_plastic(method_)) parameters.tolerance = s_.tolerance;
        stepper_ = std::make_unique<ductile::ode::World>(world_, parameters);
        if (is_plastic(method_)) {
            stepper_->on_contacts({.group = contacts_, .thickness = s_.height},
                                  [this] { collide(0); });
        }
        dRandSetSeed(0); // the iterative solver shuffles its rows
        dWorldSetGravity(world_, 0, dReal(-s_.gravity), 0);
        dWorldSetQuickStepNumIterations(world_, s_.iterations);
        if (!is_plastic(method_)) meter_ = std::make_unique<ductile::ode::EnergyMeter>(world_);
        add_hammer();
        add_specimen();
        join_specimen();
        pair_edges();
        if (meter_) meter_->open();
    }

    ~OdeScene() = default;
    OdeScene(const OdeScene&) = delete;
    OdeScene& operator=(const OdeScene&) = delete;

    double step(double dt) {
        using clock = std::chrono::steady_clock;
        auto start = clock::now();
        if (is_plastic(method_)) {
            stepper_->step(dt);
            return std::chrono::duration<double>(clock::now() - start).count();
        }
        dWorldSetERP(world_, dReal(drift_correction(dt)));
        for (const Spring& spring : springs_) set_spring(spring, dt);
        for (const Spring& spring : motor_springs_) set_motor_spring(spring, dt);
        start = clock::now();
        collide(dt);
        std::chrono::duration<double> wall = clock::now() - start;
        meter_->before_step();
        start = clock::now();
        stepper_->step(dt);
        break_joints();
        wall += clock::now() - start;
        meter_->after_step(dt);
        dJointGroupEmpty(contacts_);
        return wall.count();
    }

    [[nodiscard]] BlowMotion motion() const {
        return blow_motion(s_, nose_tip().x() - front(), nose_speed() + middle_speed(), parts_,
                           [](dBodyID part) { return ductile::ode::angular_velocity(part).y(); });
    }

    [[nodiscard]] const ductile::Ledger<double>& ledger() const {
        return meter_ ? meter_->ledger() : stepper_->ledger();
    }
    [[nodiscard]] const ductile::RunReport* run() const {
        return is_plastic(method_) ? &stepper_->run() : nullptr;
    }
    [[nodiscard]] double hammer_energy() const {
        return kinetic(hammer_) + s_.hammer_potential(position(hammer_).y());
    }
    [[nodiscard]] double nose_speed() const { return -velocity_at(hammer_, nose_tip()).x(); }
    [[nodiscard]] double nose_travel() const { return s_.height - nose_tip().x(); }
    [[nodiscard]] double specimen_kinetic() const {
        double sum = 0;
        for (dBodyID part : parts_) sum += kinetic(part);
        return sum;
    }
    [[nodiscard]] double joint_work() const {
        double sum = plastic_.absorbed();
        for (dJointID joint : engine_joints_) sum += meter_->taken_by(joint);
        return sum;
    }
    [[nodiscard]] double stored() const { return plastic_.stored(); }
    [[nodiscard]] double joint_travel() const {
        return plastic_.empty() ? std::abs(rotation()) : plastic_.travel();
    }
    /// Angle between the outermost parts: the bend of the whole specimen [rad].
    [[nodiscard]] double rotation() const {
        const Rotation relative = basis(parts_.front()).transpose() * basis(parts_.back());
        return std::atan2(relative(0, 2), relative(0, 0));
    }
    [[nodiscard]] bool broken() const {
        return plastic_.broken() ||
               std::any_of(engine_joints_.begin(), engine_joints_.end(),
                           [](dJointID joint) { return dJointIsEnabled(joint) == 0; });
    }
    [[nodiscard]] bool unreliable() const { return plastic_.unreliable(); }

  private:
    /// One edge against one face; the striker is null for an anvil.
    struct Pair {
        dBodyID striker;
        Edge edge; ///< in the striker's frame
        dBodyID part;
        double side; ///< of the part's face
        bool made;
    };
    struct Spring {
        dJointID joint;
        double stiffness; ///< [N m/rad]
    };

    static Vector position(dBodyID body) { return ductile::ode::to_core(dBodyGetPosition(body)); }
    static Rotation basis(dBodyID body) {
        return ductile::ode::matrix_to_core(dBodyGetRotation(body));
    }
    static Vector velocity_at(dBodyID body, const Vector& point) {
        return ductile::ode::linear_velocity(body) +
               ductile::ode::angular_velocity(body).cross(point - position(body));
    }
    static double kinetic(dBodyID body) {
        const Vector v = ductile::ode::linear_velocity(body);
        const Vector w = ductile::ode::angular_velocity(body);
        return (ductile::ode::mass(body) * v.squaredNorm() +
                w.dot(ductile::ode::inertia(body) * w)) /
               2;
    }

    dBodyID add_body(double mass, const Vector& inertia, const Vector& at) {
        dBodyID body = dBodyCreate(world_);
        dMass m;
        dMassSetParameters(&m, dReal(mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                           dReal(inertia.z()), 0, 0, 0);
        dBodySetMass(body, &m);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetFiniteRotationMode(body, 1);
        meter_ ? meter_->add(body) : stepper_->add(body);
        return body;
    }

    void add_hammer() {
        const double centre = s_.hammer_centre();
        const double mass = s_.total_hammer_mass();
        const double about_centre = s_.hammer_inertia() - mass * centre * centre;
        nose_local_ = Vector(-s_.hammer_width / 2 - s_.nose_length, centre - s_.swing_radius, 0);
        const Vector pivot(s_.pivot_x(), s_.pivot_y(), 0);
        const double angle = s_.angle_before_strike(), spin = s_.spin_before_strike();
        const Vector arm = Eigen::AngleAxisd(angle, Vector::UnitZ()) * Vector(0, -centre, 0);
        hammer_ = add_body(mass, Vector::Constant(about_centre), pivot + arm);
        dMatrix3 rotation;
        dRFromAxisAndAngle(rotation, 0, 0, 1, dReal(angle));
        dBodySetRotation(hammer_, rotation);
        dBodySetLinearVel(hammer_, dReal(-spin * arm.y()), dReal(spin * arm.x()), 0);
        dBodySetAngularVel(hammer_, 0, 0, dReal(spin));
        dJointID joint = dJointCreateHinge(world_, nullptr);
        dJointAttach(joint, hammer_, nullptr);
        dJointSetHingeAnchor(joint, dReal(pivot.x()), dReal(pivot.y()), dReal(pivot.z()));
        dJointSetHingeAxis(joint, 0, 0, 1);
    }

    void add_specimen() {
        const int count = method_ == Method::rigid ? 1 : s_.parts;
        const double length = s_.length / count;
        const double mass = s_.specimen_mass() / count;
        part_half_ = Vector(s_.height, s_.width, length) / 2;
        const Vector square = Vector(s_.height, s_.width, length).cwiseAbs2();
        const Vector inertia = mass / 12 * (Vector::Constant(square.sum()) - square);
        for (int i = 0; i < count; ++i) {
            const double z = -s_.length / 2 + (i + 0.5) * length;
            parts_.push_back(add_body(mass, inertia,
                                      Vector(s_.height / 2, s_.specimen_bottom + s_.width / 2, z)));
            dBodySetGravityMode(parts_.back(), 0);
        }
    }

    void join_specimen() {
        for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
            const bool notched = i + 1 == parts_.size() / 2;
            const Vector anchor = (position(parts_[i]) + position(parts_[i + 1])) / 2;
            join(parts_[i], parts_[i + 1], anchor, notched);
        }
    }

    template <template <class> class Constraint, class Frame, class Law>
    void add_plastic(dBodyID a, dBodyID b, const Frame& frame, Law law) {
        stepper_->add(
            plastic_.add(std::make_unique<Constraint<Law>>(world_, a, b, frame, std::move(law))));
    }

    void join(dBodyID a, dBodyID b, const Vector& anchor, bool notched) {
        using ductile::ode::PlasticHinge, ductile::ode::PlasticJoint;
        // x of the section along y, its y along -x, z along the specimen
        const Rotation along = Eigen::AngleAxisd(std::numbers::pi / 2, Vector::UnitZ()).matrix();
        const ductile::JointFrame<double> section{.origin = anchor, .axes = along};
        const ductile::ode::HingeFrame hinge{.anchor = anchor, .axis = Vector::UnitY()};
        const double moment = notched ? s_.notched_moment() : s_.full_moment();
        switch (method_) {
            case Method::rigid:
                return;
            case Method::plastic_hinge:
                return add_plastic<PlasticHinge>(a, b, hinge, hinge_law(s_, notched));
            case Method::elastic_plastic:
                return add_plastic<PlasticJoint>(a, b, section, axes_law(s_, notched));
            case Method::elastic_plastic_2:
                return add_plastic<PlasticJoint>(a, b, section, surface_law(s_, notched));
            case Method::zero_limits: {
                dJointID joint = add_hinge(a, b, anchor);
                stop_at_zero(joint);
                dJointSetFeedback(joint, &feedback_.emplace_back());
                return;
            }
            case Method::spring: {
                dJointID joint = add_hinge(a, b, anchor);
                stop_at_zero(joint);
                springs_.push_back({joint, moment}); // the source's stiffness: M_p per radian
                return;
            }
            case Method::spring2: {
                motor_springs_.push_back({add_hinge(a, b, anchor), moment});
                return;
            }
            case Method::hinge_motor: {
                dJointID joint = add_hinge(a, b, anchor);
                dJointSetHingeParam(joint, dParamVel, 0);
                dJointSetHingeParam(joint, dParamFMax, dReal(moment));
                return;
            }
        }
    }

    dJointID add_hinge(dBodyID a, dBodyID b, const Vector& anchor) {
        dJointID joint = dJointCreateHinge(world_, nullptr);
        dJointAttach(joint, a, b);
        dJointSetHingeAnchor(joint, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
        dJointSetHingeAxis(joint, 0, 1, 0);
        engine_joints_.push_back(joint);
        return joint;
    }
    static void stop_at_zero(dJointID joint) {
        dJointSetHingeParam(joint, dParamLoStop, 0);
        dJointSetHingeParam(joint, dParamHiStop, 0);
    }

    /// ODE's spring: a stop with lo = hi and, by its manual, ERP = dt k/(dt k + c) and CFM = 1/(dt
    /// k + c) with no damping, c = 0.
    static void set_spring(const Spring& spring, double dt) {
        dJointSetHingeParam(spring.joint, dParamStopERP, 1);
        dJointSetHingeParam(spring.joint, dParamStopCFM, dReal(1 / (dt * spring.stiffness)));
    }

    /// The spring's moment as that of a motor whose target is out of reach [rad/s].
    void set_motor_spring(const Spring& spring, double dt) const {
        constexpr double out_of_reach = 1e6, phase = 0.25; // [rad/s], [rad a step]
        const double mass = s_.specimen_mass() / double(parts_.size());
        const double length = s_.length / double(parts_.size());
        // of two parts that turn about the joint between them
        const double inertia = mass * (length * length / 3 + s_.height * s_.height / 12) / 2;
        const double softened = std::min(spring.stiffness, inertia * phase * phase / (dt * dt));
        const double moment = -softened * double(dJointGetHingeAngle(spring.joint));
        dJointSetHingeParam(spring.joint, dParamFMax, dReal(std::abs(moment)));
        dJointSetHingeParam(spring.joint, dParamVel, dReal(std::copysign(out_of_reach, moment)));
    }

    /// As Bullet's breaking threshold: where a force or a moment is above M_p.
    void break_joints() {
        if (method_ != Method::zero_limits) return;
        for (dJointID joint : engine_joints_) {
            const dJointFeedback* feedback = dJointGetFeedback(joint);
            const double most = std::max(ductile::ode::to_core(feedback->f1).cwiseAbs().maxCoeff(),
                                         ductile::ode::to_core(feedback->t1).cwiseAbs().maxCoeff());
            if (most >= s_.notched_moment()) dJointDisable(joint);
        }
    }

    /// Every edge may touch every part.
    void pair_edges() {
        for (dBodyID part : parts_) {
            for (const Edge& edge : hammer_edges(s_.flat(), s_.nose_length, s_.hammer_thickness,
                                                 s_.hammer_height / 2)) {
                pairs_.push_back(
                    {hammer_, {nose_local_ + edge.from, nose_local_ + edge.to}, part, 1, false});
            }
            for (const double side : {-1.0, 1.0}) {
                const Vector anvil(0, s_.specimen_bottom + s_.width / 2, side * s_.anvil_gap / 2);
                const Vector high(0, 2.5 * s_.width, 0);
                pairs_.push_back({nullptr, {anvil - high, anvil + high}, part, -1, false});
            }
        }
    }

    /// For a step of `dt` [s]; 0: for a part of a frame, whose contacts are those that overlap.
    void collide(double dt) {
        const double closing = nose_speed() + middle_speed();
        contact_count_ = 0;
        for (Pair& pair : pairs_) {
            const auto world = [&pair](const Vector& local) {
                if (pair.striker == nullptr) return local;
                return Vector(position(pair.striker) + basis(pair.striker) * local);
            };
            const double margin =
                dt == 0 ? 0
                        : reach(pair.made, s_.height, pair.striker != nullptr ? closing : 0, dt);
            const EdgeContact contact =
                touch({world(pair.edge.from), world(pair.edge.to)},
                      {position(pair.part), basis(pair.part), part_half_, pair.side}, margin);
            pair.made = contact.count > 0;
            for (int i = 0; i < contact.count; ++i) {
                add_contact(pair, contact.points[std::size_t(i)], dt);
            }
        }
    }

    void add_contact(const Pair& pair, const ContactPoint& point, double dt) {
        constexpr double slowest = 0.2; // that rebounds, as Bullet has it [m/s]
        dContact contact{};
        dSurfaceParameters& surface = contact.surface;
        surface.mode = dContactApprox1 | dContactMotionN | dContactSoftCFM;
        surface.soft_cfm = dReal(compliance(s_.restitution));
        surface.mu = dReal(s_.friction);
        // the direct solver's pivoting stalls where symmetric contacts reach their bound at once:
        // no two are quite alike
        const double unlike = 1e-6 * (1 + 0.37 * contact_count_++);
        if (dt == 0) {
            surface.mode |= dContactBounce;
            surface.bounce = dReal(s_.restitution);
            surface.bounce_vel = dReal(slowest);
            surface.motionN = dReal(-unlike);
        } else {
            const double parting = rebound(s_.restitution, closing_speed(pair, point));
            surface.motionN =
                dReal((parting > 0 ? parting : -std::max(point.gap, 0.0) / dt) - unlike);
        }
        contact.geom.depth = dReal(std::max(-point.gap, 0.0));
        for (int i = 0; i < 3; ++i) {
            contact.geom.pos[i] = dReal(point.position[i]);
            contact.geom.normal[i] = dReal(-point.normal[i]); // into the first body, the part
        }
        dJointID joint = dJointCreateContact(world_, contacts_, &contact);
        dJointAttach(joint, pair.part, pair.striker);
        if (meter_) meter_->add_contact(joint, contact.geom);
        stepper_->add_contact(joint, contact);
    }

    /// How fast the edge closes in on the face at a point of contact [m/s].
    static double closing_speed(const Pair& pair, const ContactPoint& point) {
        const Vector edge = pair.striker == nullptr ? Vector(Vector::Zero())
                                                    : velocity_at(pair.striker, point.position);
        return (velocity_at(pair.part, point.position) - edge).dot(point.normal);
    }

    [[nodiscard]] Vector nose_tip() const {
        return position(hammer_) + basis(hammer_) * nose_local_;
    }
    /// x of the struck face at the middle of the specimen [m].
    [[nodiscard]] double front() const {
        return position(parts_[parts_.size() / 2]).x() + s_.height / 2;
    }
    [[nodiscard]] double middle_speed() const {
        return ductile::ode::linear_velocity(parts_[parts_.size() / 2]).x();
    }

    /// What ODE gives and takes back, also where the scene is refused. ODE counts its users:
    /// initialised once per scene, before the world.
    struct Owned {
        Owned() {
            dInitODE2(0);
            world = dWorldCreate();
            contacts = dJointGroupCreate(0);
        }
        ~Owned() {
            dJointGroupDestroy(contacts);
            dWorldDestroy(world);
            dCloseODE();
        }
        Owned(const Owned&) = delete;
        Owned& operator=(const Owned&) = delete;

        dWorldID world = nullptr;
        dJointGroupID contacts = nullptr;
    };

    Scenario s_;
    Method method_;
    Owned owned_; ///< outlives what follows
    dWorldID world_ = owned_.world;
    dJointGroupID contacts_ = owned_.contacts;
    std::unique_ptr<ductile::ode::World> stepper_;
    std::unique_ptr<ductile::ode::EnergyMeter> meter_; ///< of the engine's own joints
    Joints plastic_;
    std::vector<dJointID> engine_joints_;
    std::vector<Spring> springs_;
    std::vector<Spring> motor_springs_;
    std::deque<dJointFeedback> feedback_;
    dBodyID hammer_ = nullptr;
    std::vector<dBodyID> parts_;
    Vector nose_local_{0, 0, 0};
    Vector part_half_{0, 0, 0};
    std::vector<Pair> pairs_;
    int contact_count_ = 0;
};

static_assert(Simulation<OdeScene>);

} // namespace charpy
