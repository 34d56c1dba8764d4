// SPDX-License-Identifier: MIT
//
// A steel bar of several rods three times, side by side: held together by this library's hinges, by
// Bullet's hinges with motors, and by Bullet's springs that break. For a page (page.js), by a C
// interface; compiled by build.sh.
//
// Thrown: a post, with a mass on its tip, turns about its foot. The foot takes all of the energy:
// it stops after E/M_p, whatever the number of rods, or breaks before. Loaded: a cantilever under
// its own weight, which grows for a second, with a mass on its tip: the root carries q L²/2 + G g L,
// and stands where that is below M_p. Both are what a rigid-plastic bar does, exactly.
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "ductile/material.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/capacity.hpp"

using namespace ductile;

namespace {

/// As page.js lays them down.
struct Wish {
    double loaded;     ///< 0: thrown, 1: loaded by its weight
    double rods;       ///< >= 1
    double length;     ///< [m]
    double side, wall; ///< of the box section [m]
    double yield;      ///< [Pa]
    double mass;       ///< on the tip [kg]
    double speed;      ///< of the tip [m/s]
    double largest;    ///< plastic rotation of a hinge before it breaks [rad]
    double rate;       ///< frames a second
    double iterations; ///< of the sequential impulse solver
    double direct;     ///< 1: Dantzig's solver in its place
};

constexpr double gravity = 9.81, youngs_modulus = 210e9, grows = 1; // [m/s²], [Pa], [s]
enum class Method { ours, motor, spring };
constexpr std::array methods{Method::ours, Method::motor, Method::spring};

struct Problem {
    explicit Problem(const Wish& by)
        : wish(by),
          section({.width = by.side,
                   .height = by.side,
                   .web_thickness = by.wall,
                   .flange_thickness = by.wall}),
          steel({.density = 7850,
                 .youngs_modulus = youngs_modulus,
                 .poisson_ratio = 0.3,
                 .yield_stress = by.yield}),
          moment(plastic_moment(section, steel)), per_length(steel.density() * section.area()) {}

    Wish wish;
    Box<double> section;
    Material<double> steel;
    double moment;     ///< M_p [N m]
    double per_length; ///< [kg/m]

    [[nodiscard]] bool loaded() const { return wish.loaded > 0.5; }
    [[nodiscard]] double inertia() const {
        const double l = wish.length;
        return per_length * l * l * l / 3 + wish.mass * l * l;
    }
    [[nodiscard]] double energy() const {
        const double spin = wish.speed / wish.length;
        return loaded() ? 0 : inertia() * spin * spin / 2;
    }
    /// At the root, of its weight [-].
    [[nodiscard]] double share() const {
        const double l = wish.length;
        return gravity * (per_length * l * l / 2 + wish.mass * l) / moment;
    }
};

class Bar {
  public:
    Bar(const Problem& problem, Method method) : problem_(problem), method_(method) {
        const Wish& wish = problem.wish;
        if (wish.direct > 0.5) {
            solver_ = std::make_unique<btMLCPSolver>(&dantzig_);
        } else {
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        }
        engine_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_,
                                                            solver_.get(), &configuration_);
        engine_->getSolverInfo().m_numIterations = int(wish.iterations);
        engine_->setGravity({0, 0, 0});
        if (method == Method::ours) {
            bullet::WorldParameters of_world;
            of_world.tolerance = 0.01;
            of_world.warn = {};
            world_ = std::make_unique<bullet::World>(*engine_, of_world);
        }
        build();
    }
    ~Bar() {
        for (const auto& constraint : constraints_) engine_->removeConstraint(constraint.get());
        hinges_.clear();
        world_.reset();
        for (const auto& body : bodies_) engine_->removeRigidBody(body.get());
    }

    void step(double frame, double time) {
        if (problem_.loaded()) engine_->setGravity({0, 0, -gravity * std::min(1.0, time / grows)});
        const auto start = std::chrono::steady_clock::now();
        const btScalar height = potential();
        if (world_) {
            world_->step(frame);
        } else {
            engine_->stepSimulation(frame, 0);
        }
        // by the weight of the frame: gravity is constant within it
        fallen_ += height - potential();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        cost_ = std::max(cost_, took.count());
    }

    /// What page.js reads of each: see there.
    void tell(std::vector<double>& into) const {
        const double kinetic = energy();
        double taken = problem_.energy() + fallen_ - kinetic;
        double broken = 0, doubtful = 0;
        if (method_ == Method::ours) {
            taken = 0;
            for (const auto& hinge : hinges_) {
                taken += hinge->absorbed_energy();
                broken += hinge->broken() ? 1 : 0;
            }
            doubtful = world_->run().believed() ? 0 : 1;
        } else {
            for (const auto& constraint : constraints_) broken += constraint->isEnabled() ? 0 : 1;
        }
        into.insert(into.end(), {kinetic, taken, turn(0), cost_, broken, doubtful});
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const btVector3 at = bodies_[i]->getCenterOfMassPosition();
            into.insert(into.end(), {at.x(), at.z(), turn(i)});
        }
    }

  private:
    void build() {
        const Wish& wish = problem_.wish;
        const int rods = int(wish.rods);
        const double part = wish.length / rods, spin = wish.speed / wish.length;
        shape_ = std::make_unique<btEmptyShape>();
        for (int i = 0; i < rods; ++i) {
            // the mass on the tip is of the last rod
            const double rod = problem_.per_length * part, tip = i == rods - 1 ? wish.mass : 0;
            const double mass = rod + tip, low = part * i;
            const double centre = (rod * (low + part / 2) + tip * wish.length) / mass;
            const double from = centre - (low + part / 2), to = wish.length - centre;
            const double about =
                rod * (part * part / 12 + from * from) + (tip > 0 ? tip * to * to : 0.0);
            btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape_.get(),
                                                          {about, about, about});
            info.m_startWorldTransform.setOrigin(point(centre));
            auto& body = bodies_.emplace_back(std::make_unique<btRigidBody>(info));
            body->setActivationState(DISABLE_DEACTIVATION);
            if (!problem_.loaded()) {
                body->setAngularVelocity({0, spin, 0});
                body->setLinearVelocity({spin * centre, 0, 0});
            }
            engine_->addRigidBody(body.get(), 0, 0);
            starts_.push_back(low - centre);
        }
        for (int i = 0; i < rods; ++i) join(i, part);
    }
    /// `along` from the root.
    [[nodiscard]] btVector3 point(double along) const {
        return problem_.loaded() ? btVector3(along, 0, 0) : btVector3(0, 0, along);
    }
    void join(int i, double part) {
        const Wish& wish = problem_.wish;
        btRigidBody& above = *bodies_[std::size_t(i)];
        btRigidBody& below =
            i == 0 ? btTypedConstraint::getFixedBody() : *bodies_[std::size_t(i) - 1];
        const btTransform at(shortestArcQuat({0, 0, 1}, {0, 1, 0}), point(part * i));
        const btTransform in_above = above.getCenterOfMassTransform().inverse() * at;
        const btTransform in_below = below.getCenterOfMassTransform().inverse() * at;
        if (method_ == Method::ours) {
            auto& hinge = hinges_.emplace_back(std::make_unique<bullet::PlasticHinge<UsualAxisJoint>>(
                above, below, in_above, in_below,
                UsualAxisJoint(Perfect<double>({.strength = problem_.moment}),
                               TravelLimit<double>({.limit = wish.largest}))));
            world_->add(*hinge);
            return;
        }
        const double impulse = problem_.moment / wish.rate; // of M_p over a step
        if (method_ == Method::motor) {
            auto hinge = std::make_unique<btHingeConstraint>(above, below, in_above, in_below);
            hinge->enableAngularMotor(true, 0, impulse);
            constraints_.push_back(std::move(hinge));
        } else {
            auto spring = std::make_unique<btGeneric6DofSpring2Constraint>(above, below, in_above, in_below);
            spring->setLinearLowerLimit({0, 0, 0});
            spring->setLinearUpperLimit({0, 0, 0});
            spring->setAngularLowerLimit({0, 0, 1}); // z is free: lower above upper
            spring->setAngularUpperLimit({0, 0, -1});
            spring->enableSpring(5, true);
            spring->setStiffness(5, youngs_modulus * problem_.section.second_moment(SectionAxis::x) / part);
            spring->setDamping(5, 0);
            spring->setEquilibriumPoint();
            spring->setBreakingImpulseThreshold(impulse);
            constraints_.push_back(std::move(spring));
        }
        engine_->addConstraint(constraints_.back().get());
    }

    /// About y, from the start [rad].
    [[nodiscard]] double turn(std::size_t i) const {
        const btMatrix3x3& axes = bodies_[i]->getCenterOfMassTransform().getBasis();
        return std::atan2(axes[0][2], axes[2][2]);
    }
    [[nodiscard]] double energy() const {
        double sum = 0;
        for (const auto& body : bodies_) {
            const double inertia = 1 / body->getInvInertiaDiagLocal().y();
            sum += (body->getLinearVelocity().length2() / body->getInvMass() +
                    inertia * body->getAngularVelocity().length2()) /
                   2;
        }
        return sum;
    }
    [[nodiscard]] double potential() const {
        double sum = 0;
        for (const auto& body : bodies_) {
            sum -= engine_->getGravity().z() * body->getCenterOfMassPosition().z() / body->getInvMass();
        }
        return sum;
    }

    Problem problem_;
    Method method_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btDantzigSolver dantzig_;
    std::unique_ptr<btConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> engine_;
    std::unique_ptr<btCollisionShape> shape_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<double> starts_; ///< of each rod, from its centre [m]
    std::unique_ptr<bullet::World> world_;
    std::vector<std::unique_ptr<bullet::PlasticHinge<UsualAxisJoint>>> hinges_;
    std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
    double fallen_ = 0; ///< work of the weight [J]
    double cost_ = 0;   ///< dearest frame [ms]
};

struct Live {
    explicit Live(const Wish& wish) : problem(wish) {
        for (const Method method : methods) bars.push_back(std::make_unique<Bar>(problem, method));
    }
    Problem problem;
    std::vector<std::unique_ptr<Bar>> bars;
    long frames = 0;
};

std::unique_ptr<Live> live;
std::string fault;
Wish wish;
std::vector<double> state;

} // namespace

extern "C" {

double* live_wish() { return &wish.loaded; }

/// Empty where it went well, else why not.
const char* live_start() {
    fault.clear();
    try {
        live.reset();
        live = std::make_unique<Live>(wish);
    } catch (const std::exception& error) {
        fault = error.what();
    }
    return fault.c_str();
}

void live_step() {
    if (!live) return;
    const double frame = 1 / live->problem.wish.rate;
    ++live->frames;
    for (const auto& bar : live->bars) bar->step(frame, double(live->frames) * frame);
}

/// time, M_p, energy, root's share by weight, rods; then of each bar kinetic, taken, turn of the
/// foot, dearest frame [ms], broken, doubtful, and of each rod x, z, turn.
const double* live_state() {
    state.clear();
    if (!live) return nullptr;
    const Problem& problem = live->problem;
    state.insert(state.end(), {double(live->frames) / problem.wish.rate, problem.moment,
                               problem.energy(), problem.share(), problem.wish.rods});
    for (const auto& bar : live->bars) bar->tell(state);
    return state.data();
}
}
