// SPDX-License-Identifier: MIT
//
// The Charpy test in Bullet. Contacts are set up so that the engine neither adds nor takes energy
// with them: the contact points are those of edge_contact.hpp, made where Bullet makes its own
// (bullet_contacts.hpp), and split impulse corrects positions apart from velocities at any depth.
// Bodies do not collide otherwise.
//
// The specimen is weightless until struck: it stands for one that rests on a shelf. In the 5 ms of
// the blow gravity would move it by 0.1 mm.
#pragma once

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_contacts.hpp"
#include "ductile/bullet/bullet.hpp"
#include "ductile/bullet/energy_meter.hpp"
#include "ductile/bullet/island_solver.hpp"
#include "simulation.hpp"
#include "specimen_joints.hpp"

namespace charpy {

class BulletScene {
    using Joints = SpecimenJoints<ductile::bullet::PlasticHinge, ductile::bullet::PlasticJoint>;

  public:
    static constexpr std::string_view engine = "bullet";
#ifdef BT_USE_DOUBLE_PRECISION
    static constexpr std::string_view precision = "double";
#else
    static constexpr std::string_view precision = "float";
#endif

    BulletScene(const Scenario& scenario, Method method, const std::string& solver)
        : s_(scenario), method_(method) {
        make_world(solver);
        add_anvils();
        add_hammer();
        add_specimen();
        join_specimen();
        pair_edges();
        if (!keeper_) meter_ = std::make_unique<ductile::bullet::EnergyMeter>(*world_);
    }

    ~BulletScene() {
        meter_.reset();
        plastic_.for_each([this](auto& joint) { joint.remove_from(*world_); });
        keeper_.reset();
        for (auto& constraint : constraints_) world_->removeConstraint(constraint.get());
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }
    BulletScene(const BulletScene&) = delete;
    BulletScene& operator=(const BulletScene&) = delete;

    double step(double dt) {
        using clock = std::chrono::steady_clock;
        if (keeper_) {
            const auto start = clock::now();
            keeper_->step(dt);
            return std::chrono::duration<double>(clock::now() - start).count();
        }
        // btHingeConstraint takes an impulse, so its strength has to follow the step
        for (const Motor& motor : motors_) {
            motor.joint->enableAngularMotor(true, 0, scalar(motor.moment * dt));
        }
        for (btTypedConstraint* joint : breakable_) {
            joint->setBreakingImpulseThreshold(scalar(s_.notched_moment() * dt));
        }
        world_->getSolverInfo().m_erp = scalar(drift_correction(dt));
        meter_->before_step();
        const auto start = clock::now();
        world_->stepSimulation(scalar(dt), 0);
        const std::chrono::duration<double> wall = clock::now() - start;
        meter_->after_step(dt);
        return wall.count();
    }

    [[nodiscard]] BlowMotion motion() const {
        return blow_motion(
            s_, double(nose_tip().x()) - front(), nose_speed() + middle_speed(), parts_,
            [](const btRigidBody* part) { return double(part->getAngularVelocity().y()); });
    }

    [[nodiscard]] const ductile::Ledger<double>& ledger() const {
        return keeper_ ? keeper_->ledger() : meter_->ledger();
    }
    [[nodiscard]] const ductile::RunReport* run() const {
        return keeper_ ? &keeper_->run() : nullptr;
    }
    [[nodiscard]] double hammer_energy() const {
        return kinetic(*hammer_) +
               s_.hammer_potential(double(hammer_->getCenterOfMassPosition().y()));
    }
    [[nodiscard]] double nose_speed() const {
        const btVector3 arm = hammer_->getCenterOfMassTransform().getBasis() * nose_local_;
        return -double(hammer_->getVelocityInLocalPoint(arm).x());
    }
    [[nodiscard]] double nose_travel() const { return s_.height - nose_tip().x(); }
    [[nodiscard]] double specimen_kinetic() const {
        double sum = 0;
        for (const btRigidBody* part : parts_) sum += kinetic(*part);
        return sum;
    }
    [[nodiscard]] double joint_work() {
        double sum = plastic_.absorbed();
        for (const btTypedConstraint* joint : engine_joints_) sum += meter_->taken_by(*joint);
        return sum;
    }
    [[nodiscard]] double stored() { return plastic_.stored(); }
    [[nodiscard]] double joint_travel() {
        return plastic_.empty() ? std::abs(rotation()) : plastic_.travel();
    }
    /// Angle between the outermost parts: the bend of the whole specimen [rad].
    [[nodiscard]] double rotation() const {
        const btMatrix3x3 relative =
            parts_.front()->getCenterOfMassTransform().getBasis().transposeTimes(
                parts_.back()->getCenterOfMassTransform().getBasis());
        return std::atan2(double(relative[0][2]), double(relative[0][0]));
    }
    [[nodiscard]] bool broken() {
        return plastic_.broken() ||
               std::any_of(engine_joints_.begin(), engine_joints_.end(),
                           [](const btTypedConstraint* joint) { return !joint->isEnabled(); });
    }
    [[nodiscard]] bool unreliable() { return plastic_.unreliable(); }

  private:
    /// An engine's hinge with its motor as a plastic hinge.
    struct Motor {
        btHingeConstraint* joint;
        double moment; ///< [N m]
    };

    static btScalar scalar(double value) { return btScalar(value); }
    static btVector3 vector(double x, double y, double z) {
        return {btScalar(x), btScalar(y), btScalar(z)};
    }
    static double kinetic(const btRigidBody& body) {
        const auto v = ductile::bullet::to_core(body.getLinearVelocity());
        const btVector3 turned =
            body.getAngularVelocity() * body.getCenterOfMassTransform().getBasis();
        const auto w = ductile::bullet::to_core(turned);
        const auto inertia = ductile::bullet::to_core(body.getLocalInertia());
        return double(body.getMass()) * v.squaredNorm() / 2 + w.cwiseAbs2().dot(inertia) / 2;
    }

    void make_world(const std::string& solver) {
        configuration_ = std::make_unique<btDefaultCollisionConfiguration>();
        dispatcher_ = std::make_unique<BulletContacts>(configuration_.get());
        broadphase_ = std::make_unique<btDbvtBroadphase>();
        if (solver == "mlcp") {
            solver_ = std::make_unique<btMLCPSolver>(&dantzig_);
        } else if (solver == "island") {
            solver_ = std::make_unique<ductile::bullet::IslandSolver>();
        } else if (solver == "si") {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        } else if (solver == "nncg") {
            solver_ = std::make_unique<btNNCGConstraintSolver>();
        } else {
            throw std::invalid_argument("--solver = " + solver + ": must be " +
                                        std::string(bullet_solvers) + " with --engine bullet");
        }
        world_ = std::make_unique<btDiscreteDynamicsWorld>(dispatcher_.get(), broadphase_.get(),
                                                           solver_.get(), configuration_.get());
        if (is_plastic(method_)) {
            keeper_ = std::make_unique<ductile::bullet::World>(
                *world_,
                ductile::bullet::WorldParameters{.tolerance = s_.tolerance, .warn = nullptr});
        }
        dispatcher_->filter(*broadphase_->getOverlappingPairCache());
        dispatcher_->make_ahead(is_plastic(method_));
        dispatcher_->make_unlike(true);
        world_->setGravity(vector(0, -s_.gravity, 0));
        btContactSolverInfo& info = world_->getSolverInfo();
        info.m_numIterations = s_.iterations;
        info.m_splitImpulse = true;
        info.m_splitImpulsePenetrationThreshold = scalar(1e30); // at any depth
        info.m_globalCfm = scalar(compliance(s_.restitution));
    }

    btRigidBody& add_body(btCollisionShape& shape, double mass, const btVector3& inertia,
                          const btTransform& transform) {
        btRigidBody::btRigidBodyConstructionInfo info(scalar(mass), nullptr, &shape, inertia);
        info.m_startWorldTransform = transform;
        btRigidBody& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_->addRigidBody(&body);
        return body;
    }
    btBoxShape& box(double x, double y, double z) {
        shapes_.push_back(std::make_unique<btBoxShape>(vector(x / 2, y / 2, z / 2)));
        return static_cast<btBoxShape&>(*shapes_.back());
    }

    void add_anvils() {
        const double depth = s_.anvil_width;
        for (const double side : {-1.0, 1.0}) {
            const double z = side * (s_.anvil_gap + s_.anvil_width) / 2;
            const btTransform at(btQuaternion::getIdentity(),
                                 vector(-depth / 2, s_.specimen_bottom + s_.width / 2, z));
            anvils_.push_back(
                &add_body(box(depth, 5 * s_.width, s_.anvil_width), 0, vector(0, 0, 0), at));
        }
    }

    void add_hammer() {
        const double centre = s_.hammer_centre();
        const double mass = s_.total_hammer_mass();
        auto shape = std::make_unique<btCompoundShape>();
        const auto part = [&](btBoxShape& child, double x, double y) {
            shape->addChildShape(btTransform(btQuaternion::getIdentity(), vector(x, y + centre, 0)),
                                 &child);
        };
        part(box(s_.hammer_width, s_.hammer_height, s_.hammer_thickness), 0, -s_.swing_radius);
        part(box(s_.nose_length, s_.hammer_height, s_.nose_width),
             -(s_.hammer_width + s_.nose_length) / 2, -s_.swing_radius);
        const double about_centre = s_.hammer_inertia() - mass * centre * centre;
        nose_local_ = vector(-s_.hammer_width / 2 - s_.nose_length, centre - s_.swing_radius, 0);

        const btVector3 pivot = vector(s_.pivot_x(), s_.pivot_y(), 0);
        const btQuaternion raised(vector(0, 0, 1), scalar(s_.angle_before_strike()));
        const btVector3 arm = quatRotate(raised, vector(0, -centre, 0));
        const btVector3 spin = vector(0, 0, s_.spin_before_strike());
        hammer_ = &add_body(*shape, mass, vector(about_centre, about_centre, about_centre),
                            btTransform(raised, pivot + arm));
        hammer_->setLinearVelocity(spin.cross(arm));
        hammer_->setAngularVelocity(spin);
        shapes_.push_back(std::move(shape));
        add_constraint(
            std::make_unique<btHingeConstraint>(*hammer_, vector(0, centre, 0), vector(0, 0, 1)));
    }

    void add_specimen() {
        const int count = method_ == Method::rigid ? 1 : s_.parts;
        const double length = s_.length / count;
        const double mass = s_.specimen_mass() / count;
        btBoxShape& shape = box(s_.height, s_.width, length);
        part_half_ = Vector(s_.height, s_.width, length) / 2;
        const double xx = s_.height * s_.height, yy = s_.width * s_.width, zz = length * length;
        const btVector3 inertia = vector(yy + zz, xx + zz, xx + yy) * scalar(mass / 12);
        for (int i = 0; i < count; ++i) {
            const double z = -s_.length / 2 + (i + 0.5) * length;
            const btTransform at(btQuaternion::getIdentity(),
                                 vector(s_.height / 2, s_.specimen_bottom + s_.width / 2, z));
            btRigidBody& part = add_body(shape, mass, inertia, at);
            part.setGravity(vector(0, 0, 0));
            parts_.push_back(&part);
        }
    }

    /// Every edge may touch every part.
    void pair_edges() {
        const Vector tip = ductile::bullet::to_core(nose_local_);
        for (const btRigidBody* part : parts_) {
            for (const Edge& edge : hammer_edges(s_.flat(), s_.nose_length, s_.hammer_thickness,
                                                 s_.hammer_height / 2)) {
                pair(*hammer_, {tip + edge.from, tip + edge.to}, *part, 1);
            }
            for (std::size_t i = 0; i < anvils_.size(); ++i) {
                const double inner = (i == 0 ? 1 : -1) * s_.anvil_width / 2;
                const Vector edge(s_.anvil_width / 2, 0, inner);
                const Vector up(0, 2.5 * s_.width, 0);
                pair(*anvils_[i], {edge - up, edge + up}, *part, -1);
            }
        }
    }
    /// `edge` in the striker's frame; `side` of the part's face.
    void pair(const btRigidBody& striker, const Edge& edge, const btRigidBody& part, double side) {
        BulletContact contact{
            .a = &striker,
            .b = &part,
            .thickness = s_.height,
            .friction = s_.friction,
            .restitution = s_.restitution,
            .touch = [this, &striker, edge, &part, side](double margin) {
                using ductile::bullet::to_bullet, ductile::bullet::to_core;
                const btTransform &from = striker.getCenterOfMassTransform(),
                                  &to = part.getCenterOfMassTransform();
                return touch(
                    {to_core(from * to_bullet(edge.from)), to_core(from * to_bullet(edge.to))},
                    {to_core(to.getOrigin()), to_core(to.getBasis()), part_half_, side}, margin);
            }};
        if (&striker == hammer_) {
            contact.closing_speed = [this] { return nose_speed() + middle_speed(); };
        }
        dispatcher_->add(std::move(contact));
    }

    btTypedConstraint& add_constraint(std::unique_ptr<btTypedConstraint> constraint) {
        world_->addConstraint(constraint.get(), true);
        return *constraints_.emplace_back(std::move(constraint));
    }

    void join_specimen() {
        const double half = s_.length / double(parts_.size()) / 2;
        // hinges: z of the joint's frame along y, the axis of bending
        const btQuaternion upright(vector(1, 0, 0), scalar(-SIMD_HALF_PI));
        // six axes: x of the section along y, its y along -x, z along the specimen
        const btQuaternion along(vector(0, 0, 1), scalar(SIMD_HALF_PI));
        const btQuaternion& turn = is_elastic(method_) ? along : upright;
        const btTransform in_a(turn, vector(0, 0, half)), in_b(turn, vector(0, 0, -half));
        for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
            const bool notched = i + 1 == parts_.size() / 2;
            join(*parts_[i], *parts_[i + 1], in_a, in_b, notched);
        }
    }

    template <template <class> class Constraint, class Law>
    void add_plastic(btRigidBody& a, btRigidBody& b, const btTransform& in_a,
                     const btTransform& in_b, Law law) {
        keeper_->add(
            plastic_.add(std::make_unique<Constraint<Law>>(a, b, in_a, in_b, std::move(law))));
    }

    void join(btRigidBody& a, btRigidBody& b, const btTransform& in_a, const btTransform& in_b,
              bool notched) {
        using ductile::bullet::PlasticHinge, ductile::bullet::PlasticJoint;
        constexpr int bending = 5; // rotation about the frames' z
        const double moment = notched ? s_.notched_moment() : s_.full_moment();
        switch (method_) {
            case Method::rigid:
                return;
            case Method::plastic_hinge:
                return add_plastic<PlasticHinge>(a, b, in_a, in_b, hinge_law(s_, notched));
            case Method::elastic_plastic:
                return add_plastic<PlasticJoint>(a, b, in_a, in_b, axes_law(s_, notched));
            case Method::elastic_plastic_2:
                return add_plastic<PlasticJoint>(a, b, in_a, in_b, surface_law(s_, notched));
            case Method::zero_limits: {
                auto joint = std::make_unique<btGeneric6DofConstraint>(a, b, in_a, in_b, true);
                lock(*joint, -1);
                breakable_.push_back(joint.get());
                engine_joints_.push_back(&add_constraint(std::move(joint)));
                return;
            }
            case Method::spring: {
                auto joint =
                    std::make_unique<btGeneric6DofSpringConstraint>(a, b, in_a, in_b, true);
                lock(*joint, bending);
                joint->enableSpring(bending, true);
                joint->setStiffness(bending, scalar(moment)); // the seed's: M_p per radian
                joint->setDamping(bending, 1);                // Bullet: 1 is no damping
                joint->setEquilibriumPoint();
                engine_joints_.push_back(&add_constraint(std::move(joint)));
                return;
            }
            case Method::spring2: {
                auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(a, b, in_a, in_b);
                for (int axis = 0; axis < 6; ++axis) {
                    joint->setLimit(axis, axis == bending ? 1 : 0, 0); // lower > upper: free
                }
                joint->enableSpring(bending, true);
                joint->setStiffness(bending, scalar(moment), true);
                joint->setDamping(bending, 0, true);
                joint->setEquilibriumPoint();
                engine_joints_.push_back(&add_constraint(std::move(joint)));
                return;
            }
            case Method::hinge_motor: {
                auto joint = std::make_unique<btHingeConstraint>(a, b, in_a, in_b, true);
                motors_.push_back({joint.get(), moment});
                engine_joints_.push_back(&add_constraint(std::move(joint)));
                return;
            }
        }
    }

    /// Six axes locked, but for `free` (-1: none).
    static void lock(btGeneric6DofConstraint& joint, int free) {
        for (int axis = 0; axis < 6; ++axis) joint.setLimit(axis, axis == free ? 1 : 0, 0);
    }

    [[nodiscard]] btVector3 nose_tip() const {
        return hammer_->getCenterOfMassTransform() * nose_local_;
    }
    /// x of the struck face at the middle of the specimen [m].
    [[nodiscard]] double front() const {
        return double(parts_[parts_.size() / 2]->getCenterOfMassPosition().x()) + s_.height / 2;
    }
    [[nodiscard]] double middle_speed() const {
        return double(parts_[parts_.size() / 2]->getLinearVelocity().x());
    }

    Scenario s_;
    Method method_;
    std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
    std::unique_ptr<BulletContacts> dispatcher_;
    std::unique_ptr<btDbvtBroadphase> broadphase_;
    btDantzigSolver dantzig_;
    std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
    std::unique_ptr<ductile::bullet::World> keeper_;      ///< of our joints
    std::unique_ptr<ductile::bullet::EnergyMeter> meter_; ///< of the engine's own
    Joints plastic_;
    std::vector<Motor> motors_;
    std::vector<btTypedConstraint*> breakable_;
    std::vector<btTypedConstraint*> engine_joints_;
    btRigidBody* hammer_ = nullptr;
    std::vector<btRigidBody*> anvils_;
    std::vector<btRigidBody*> parts_;
    Vector part_half_{0, 0, 0};
    btVector3 nose_local_;
};

static_assert(Simulation<BulletScene>);

} // namespace charpy
