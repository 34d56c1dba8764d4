// SPDX-License-Identifier: MIT
//
// The Charpy test in ODE. Contact joints are made from the points of edge_contact.hpp; one that is
// still apart gets a target velocity that lets it close the gap in this step and no more. Bodies do
// not collide otherwise.
//
// The specimen is weightless until struck: it stands for one that rests on a shelf. In the 5 ms of the
// blow gravity would move it by 0.1 mm.
#pragma once

#include <ode/ode.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/ode/ode.hpp"
#include "edge_contact.hpp"
#include "simulation.hpp"

namespace charpy {

class OdeScene {
    using Hinge = ductile::ode::PlasticHinge<>;

  public:
    static constexpr std::string_view engine = "ode";
    static constexpr std::string_view precision = sizeof(dReal) == sizeof(double) ? "double" : "float";

    OdeScene(const Scenario& scenario, Method method, const std::string& solver)
        : s_(scenario), method_(method) {
        if (solver != "direct" && solver != "quick") {
            throw std::invalid_argument("--solver = " + solver +
                                        ": must be direct or quick with --engine ode");
        }
        require_in_ode(method);
        stepper_ = std::make_unique<ductile::ode::World>(
            world_, solver == "direct" ? ductile::ode::Solver::direct : ductile::ode::Solver::quick);
        dRandSetSeed(0); // the iterative solver shuffles its rows
        dWorldSetGravity(world_, 0, dReal(-s_.gravity), 0);
        dWorldSetQuickStepNumIterations(world_, s_.iterations);
        meter_ = std::make_unique<ductile::ode::EnergyMeter>(world_);
        add_hammer();
        add_specimen();
        join_specimen();
        pair_edges();
        meter_->open();
    }

    ~OdeScene() {
        plastic_.clear();
        dJointGroupDestroy(contacts_);
        dWorldDestroy(world_);
        dCloseODE();
    }
    OdeScene(const OdeScene&) = delete;
    OdeScene& operator=(const OdeScene&) = delete;

    double step(double dt) {
        using clock = std::chrono::steady_clock;
        dWorldSetERP(world_, dReal(drift_correction(dt)));
        for (const Spring& spring : springs_) set_spring(spring, dt);
        auto start = clock::now();
        collide(dt);
        std::chrono::duration<double> wall = clock::now() - start;
        meter_->before_step();
        start = clock::now();
        stepper_->step(dt);
        wall += clock::now() - start;
        meter_->after_step(dt);
        dJointGroupEmpty(contacts_);
        return wall.count();
    }

    [[nodiscard]] ductile::SceneMotion<double> motion() const {
        ductile::SceneMotion<double> m;
        m.thickness = s_.height;
        m.plastic_rotation_rate = rotation_rate();
        const double gap = nose_tip().x() - front();
        if (gap > 0) {
            m.gap = gap;
            m.closing_speed = std::max(nose_speed() + middle_speed(), 0.0);
        }
        return m;
    }

    [[nodiscard]] const ductile::Ledger<double>& ledger() const { return meter_->ledger(); }
    [[nodiscard]] double hammer_energy() const {
        return kinetic(hammer_) + s_.total_hammer_mass() * s_.gravity * position(hammer_).y();
    }
    [[nodiscard]] double nose_speed() const { return -velocity_at(hammer_, nose_tip()).x(); }
    [[nodiscard]] double nose_travel() const { return s_.height - nose_tip().x(); }
    [[nodiscard]] bool touching() const {
        return std::any_of(pairs_.begin(), pairs_.end(),
                           [this](const Pair& p) { return p.made && p.striker == hammer_; });
    }
    [[nodiscard]] double specimen_kinetic() const {
        double sum = 0;
        for (dBodyID part : parts_) sum += kinetic(part);
        return sum;
    }
    [[nodiscard]] double joint_work() const {
        double sum = 0;
        for (const auto& hinge : plastic_) sum += hinge->absorbed_energy();
        for (dJointID joint : engine_joints_) sum += meter_->taken_by(joint);
        return sum;
    }
    [[nodiscard]] double joint_travel() const {
        double sum = 0;
        for (const auto& hinge : plastic_) sum += hinge->plastic_rotation();
        return plastic_.empty() ? std::abs(rotation()) : sum;
    }
    /// Angle between the outermost parts: the bend of the whole specimen [rad].
    [[nodiscard]] double rotation() const {
        const Rotation relative = basis(parts_.front()).transpose() * basis(parts_.back());
        return std::atan2(relative(0, 2), relative(0, 0));
    }
    [[nodiscard]] bool broken() const {
        return std::any_of(plastic_.begin(), plastic_.end(),
                           [](const auto& hinge) { return hinge->broken(); });
    }
    /// True where a hinge says that the last step's solve should not be believed.
    [[nodiscard]] bool unreliable() const {
        return std::any_of(plastic_.begin(), plastic_.end(), [](const auto& hinge) {
            return hinge->outcome() == ductile::Outcome::unreliable;
        });
    }
    [[nodiscard]] double residual_max() const {
        double worst = 0;
        for (const auto& hinge : plastic_) worst = std::max(worst, hinge->residual_max());
        return worst;
    }

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
                w.dot(ductile::ode::inertia(body) * w)) / 2;
    }

    dBodyID add_body(double mass, const Vector& inertia, const Vector& at) {
        dBodyID body = dBodyCreate(world_);
        dMass m;
        dMassSetParameters(&m, dReal(mass), 0, 0, 0, dReal(inertia.x()), dReal(inertia.y()),
                           dReal(inertia.z()), 0, 0, 0);
        dBodySetMass(body, &m);
        dBodySetPosition(body, dReal(at.x()), dReal(at.y()), dReal(at.z()));
        dBodySetFiniteRotationMode(body, 1);
        meter_->add(body);
        return body;
    }

    void add_hammer() {
        const double centre = s_.hammer_centre();
        const double mass = s_.total_hammer_mass();
        const double about_centre = s_.hammer_inertia() - mass * centre * centre;
        nose_local_ = Vector(-s_.hammer_width / 2 - s_.nose_length, centre - s_.swing_radius, 0);
        const Vector pivot(s_.pivot_x(), s_.pivot_y(), 0);
        const Eigen::AngleAxisd raised(s_.start_angle, Vector::UnitZ());
        hammer_ = add_body(mass, Vector::Constant(about_centre),
                           pivot + raised * Vector(0, -centre, 0));
        dMatrix3 rotation;
        dRFromAxisAndAngle(rotation, 0, 0, 1, dReal(s_.start_angle));
        dBodySetRotation(hammer_, rotation);
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
            parts_.push_back(add_body(
                mass, inertia, Vector(s_.height / 2, s_.specimen_bottom + s_.width / 2, z)));
            dBodySetGravityMode(parts_.back(), 0);
        }
    }

    void join_specimen() {
        for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
            const bool notched = i + 1 == parts_.size() / 2;
            const Vector anchor = (position(parts_[i]) + position(parts_[i + 1])) / 2;
            join(parts_[i], parts_[i + 1], anchor, notched ? s_.notched_moment() : s_.full_moment());
        }
    }

    void join(dBodyID a, dBodyID b, const Vector& anchor, double moment) {
        if (method_ == Method::plastic_hinge) {
            ductile::OneAxisJoint<ductile::Perfect<double>> law(
                ductile::Perfect<double>({.strength = moment}),
                ductile::TravelLimit<double>({.limit = s_.max_plastic_rotation}));
            plastic_.push_back(std::make_unique<Hinge>(
                world_, a, b, ductile::ode::HingeFrame{.anchor = anchor, .axis = Vector::UnitY()},
                std::move(law)));
            plastic_.back()->add_to(*stepper_);
            meter_->add(*plastic_.back());
            return;
        }
        dJointID joint = dJointCreateHinge(world_, nullptr);
        dJointAttach(joint, a, b);
        dJointSetHingeAnchor(joint, dReal(anchor.x()), dReal(anchor.y()), dReal(anchor.z()));
        dJointSetHingeAxis(joint, 0, 1, 0);
        engine_joints_.push_back(joint);
        if (method_ == Method::hinge_motor) {
            dJointSetHingeParam(joint, dParamVel, 0);
            dJointSetHingeParam(joint, dParamFMax, dReal(moment));
        } else {
            dJointSetHingeParam(joint, dParamLoStop, 0);
            dJointSetHingeParam(joint, dParamHiStop, 0);
            springs_.push_back({joint, moment}); // the seed's stiffness: M_p per radian
        }
    }

    /// ODE's spring: a stop with lo = hi and, by its manual, ERP = dt k/(dt k + c) and CFM = 1/(dt k + c)
    /// with no damping, c = 0.
    static void set_spring(const Spring& spring, double dt) {
        dJointSetHingeParam(spring.joint, dParamStopERP, 1);
        dJointSetHingeParam(spring.joint, dParamStopCFM, dReal(1 / (dt * spring.stiffness)));
    }

    /// Every edge may touch every part.
    void pair_edges() {
        const double reach_y = s_.hammer_height / 2;
        for (dBodyID part : parts_) {
            for (const double side : {-1.0, 1.0}) {
                const Vector nose = nose_local_ + Vector(0, 0, side * s_.nose_width / 2);
                const Vector up(0, reach_y, 0);
                pairs_.push_back({hammer_, {nose - up, nose + up}, part, 1, false});
                const Vector anvil(0, s_.specimen_bottom + s_.width / 2, side * s_.anvil_gap / 2);
                const Vector high(0, 2.5 * s_.width, 0);
                pairs_.push_back({nullptr, {anvil - high, anvil + high}, part, -1, false});
            }
        }
    }

    void collide(double dt) {
        const double closing = nose_speed() + middle_speed();
        contact_count_ = 0;
        for (Pair& pair : pairs_) {
            const auto world = [&pair](const Vector& local) {
                if (pair.striker == nullptr) return local;
                return Vector(position(pair.striker) + basis(pair.striker) * local);
            };
            const EdgeContact contact =
                touch({world(pair.edge.from), world(pair.edge.to)},
                      {position(pair.part), basis(pair.part), part_half_, pair.side},
                      reach(pair.made, s_.height, pair.striker != nullptr ? closing : 0, dt));
            pair.made = contact.count > 0;
            for (int i = 0; i < contact.count; ++i) {
                add_contact(pair, contact.points[std::size_t(i)], dt);
            }
        }
    }

    void add_contact(const Pair& pair, const ContactPoint& point, double dt) {
        dContact contact{};
        contact.surface.mode = dContactApprox1 | dContactBounce | dContactMotionN | dContactSoftCFM;
        // keeps the direct solver from failing on redundant contacts; 10 kN yield at 1 mm/s
        contact.surface.soft_cfm = dReal(1e-7);
        contact.surface.mu = dReal(s_.friction);
        contact.surface.bounce = dReal(s_.restitution);
        // the direct solver's pivoting stalls where symmetric contacts reach their bound at once: no
        // two are quite alike
        const double unlike = 1e-6 * (1 + 0.37 * contact_count_++);
        contact.surface.motionN = dReal(-std::max(point.gap, 0.0) / dt - unlike);
        contact.geom.depth = dReal(std::max(-point.gap, 0.0));
        for (int i = 0; i < 3; ++i) {
            contact.geom.pos[i] = dReal(point.position[i]);
            contact.geom.normal[i] = dReal(-point.normal[i]); // into the first body, the part
        }
        dJointID joint = dJointCreateContact(world_, contacts_, &contact);
        dJointAttach(joint, pair.part, pair.striker);
        meter_->add_contact(joint, contact.geom);
    }

    [[nodiscard]] Vector nose_tip() const { return position(hammer_) + basis(hammer_) * nose_local_; }
    /// x of the struck face at the middle of the specimen [m].
    [[nodiscard]] double front() const {
        return position(parts_[parts_.size() / 2]).x() + s_.height / 2;
    }
    [[nodiscard]] double middle_speed() const {
        return ductile::ode::linear_velocity(parts_[parts_.size() / 2]).x();
    }
    /// Fastest relative turning of neighbouring parts [rad/s].
    [[nodiscard]] double rotation_rate() const {
        double fastest = 0;
        for (std::size_t i = 0; i + 1 < parts_.size(); ++i) {
            const double rate = ductile::ode::angular_velocity(parts_[i + 1]).y() -
                                ductile::ode::angular_velocity(parts_[i]).y();
            fastest = std::max(fastest, std::abs(rate));
        }
        return fastest;
    }

    /// ODE counts its users: initialised once per scene, before the world.
    struct Library {
        Library() { dInitODE2(0); }
    };

    Scenario s_;
    Method method_;
    Library library_;
    dWorldID world_ = dWorldCreate();
    dJointGroupID contacts_ = dJointGroupCreate(0);
    std::unique_ptr<ductile::ode::World> stepper_;
    std::unique_ptr<ductile::ode::EnergyMeter> meter_;
    std::vector<std::unique_ptr<Hinge>> plastic_;
    std::vector<dJointID> engine_joints_;
    std::vector<Spring> springs_;
    dBodyID hammer_ = nullptr;
    std::vector<dBodyID> parts_;
    Vector nose_local_{0, 0, 0};
    Vector part_half_{0, 0, 0};
    std::vector<Pair> pairs_;
    int contact_count_ = 0;
};

static_assert(Simulation<OdeScene>);

} // namespace charpy
