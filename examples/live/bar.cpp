// SPDX-License-Identifier: MIT
//
// A steel bar of several rods three times, side by side in y: held together by this library's
// hinges, by Bullet's hinges with motors, and by Bullet's springs that break. What must come out is
// said of all three.
//
// Thrown: a post, with a mass on its tip, turns about its foot. The foot takes all of the energy:
// it stops after E/M_p, whatever the number of rods, or breaks before. Loaded: a cantilever under
// its own weight, which grows for a second, with a mass on its tip: the root carries q L²/2 + G g
// L, and stands where that is below M_p. Both are what a rigid-plastic bar does, exactly.
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/bullet/bullet.hpp"
#include "ductile/material.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/capacity.hpp"
#include "joint_facts.hpp"
#include "of_bullet.hpp"
#include "scene.hpp"

namespace ductile::scenes {

std::unique_ptr<Scene> bar_scene();

namespace {

struct Wish {
    bool loaded = false;                ///< by its weight, else thrown
    double rods = 4;                    ///< >= 1
    double length = 4;                  ///< [m]
    double side = 100, wall = 4;        ///< of the box section [mm]
    double yield = 355;                 ///< [MPa]
    double mass = 100;                  ///< on the tip [kg]
    double speed = 10;                  ///< of the tip [m/s]
    double largest = 1;                 ///< plastic rotation of a hinge before it breaks [rad]
    double iterations = 10;             ///< of the sequential impulse solver
    double direct = 0;                  ///< 1: Dantzig's solver in its place
    double frame = 0, tolerance = 0.01; ///< [s], [-]
};

constexpr double gravity = 9.81, youngs_modulus = 210e9, grows = 1; // [m/s²], [Pa], [s]
enum class Method { ours, motor, spring };
constexpr std::array methods{Method::ours, Method::motor, Method::spring};
constexpr std::array names{"this library", "Bullet's motor", "Bullet's spring"};

struct Problem {
    explicit Problem(const Wish& by)
        : wish(by),
          section({.width = by.side / 1e3,
                   .height = by.side / 1e3,
                   .web_thickness = by.wall / 1e3,
                   .flange_thickness = by.wall / 1e3}),
          steel({.density = 7850,
                 .youngs_modulus = youngs_modulus,
                 .poisson_ratio = 0.3,
                 .yield_stress = by.yield * 1e6}),
          moment(plastic_moment(section, steel)),
          per_length(steel.density() * section.area()) {}

    Wish wish;
    Box<double> section;
    Material<double> steel;
    double moment;     ///< M_p [N m]
    double per_length; ///< [kg/m]

    [[nodiscard]] double inertia() const {
        const double l = wish.length;
        return per_length * l * l * l / 3 + wish.mass * l * l;
    }
    [[nodiscard]] double energy() const {
        const double spin = wish.speed / wish.length;
        return wish.loaded ? 0 : inertia() * spin * spin / 2;
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
            of_world.tolerance = wish.tolerance;
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
        if (problem_.wish.loaded)
            engine_->setGravity({0, 0, -gravity * std::min(1.0, time / grows)});
        const auto start = std::chrono::steady_clock::now();
        const btScalar height = potential();
        if (world_) {
            world_->step(frame);
        } else {
            engine_->stepSimulation(frame, 0);
        }
        // by the weight of the frame: gravity is constant within it
        fallen_ += height - potential();
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        cost_ = std::max(cost_, took.count());
    }

    /// Work that the joints took [J].
    [[nodiscard]] double taken() const {
        double sum = 0;
        for (const auto& hinge : hinges_) sum += hinge->absorbed_energy();
        return method_ == Method::ours ? sum : problem_.energy() + fallen_ - energy();
    }
    [[nodiscard]] int broken() const {
        int count = 0;
        for (const auto& hinge : hinges_) count += hinge->broken() ? 1 : 0;
        for (const auto& constraint : constraints_) count += constraint->isEnabled() ? 0 : 1;
        return count;
    }
    [[nodiscard]] double cost() const { return cost_; }
    /// The foot, about y, from the start [rad].
    [[nodiscard]] double turn() const {
        const btMatrix3x3& axes = bodies_[0]->getCenterOfMassTransform().getBasis();
        return std::atan2(axes[0][2], axes[2][2]);
    }
    /// How far the tip is below the root [m].
    [[nodiscard]] double sag() const {
        const double to = starts_.back() + problem_.wish.length / problem_.wish.rods;
        return -(bodies_.back()->getCenterOfMassTransform() * along(to)).z();
    }
    [[nodiscard]] const SteppedWorld& world() const { return *world_; }
    void record(replay::Recorder& recorder) const {
        const Wish& wish = problem_.wish;
        const double half = wish.side / 2e3, rod = wish.length / wish.rods / 2;
        const std::string name = names[std::size_t(method_)];
        const double aside = wish.length / 3 * (double(method_) - 1);
        const auto shown = [aside](const btRigidBody& body) {
            replay::Pose pose = replay::pose_of(body.getCenterOfMassTransform());
            pose.position[1] += aside;
            return pose;
        };
        replay::Body support{.name = "support of " + name, .moves = false};
        support.shapes.push_back({replay::ShapeKind::box, {2 * half, 2 * half, 2 * half}, {}});
        const btVector3 below = along(-2 * half);
        const replay::Pose at{{below.x(), aside, below.z()}};
        recorder.add(this, std::move(support), [at] { return at; });
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            replay::Body body{.name = name + ", rod " + std::to_string(i)};
            const btVector3 size =
                wish.loaded ? btVector3(rod, half, half) : btVector3(half, half, rod);
            const btVector3 middle = along(starts_[i] + rod), tip = along(starts_[i] + 2 * rod);
            body.shapes.push_back({replay::ShapeKind::box,
                                   {size.x(), size.y(), size.z()},
                                   {{middle.x(), middle.y(), middle.z()}}});
            if (i + 1 == bodies_.size()) { // a ball of steel
                const double radius = std::cbrt(wish.mass / 7850 * 3 / (4 * std::numbers::pi));
                body.shapes.push_back(
                    {replay::ShapeKind::sphere, {radius, 0, 0}, {{tip.x(), tip.y(), tip.z()}}});
            }
            const btRigidBody& of = *bodies_[i];
            recorder.add(&of, std::move(body), [&of, shown] { return shown(of); });
        }
        const std::string side = replay::quantity(wish.side / 1e3, "m");
        const std::vector<replay::Fact> words{
            {"section",
             "box " + side + " x " + side + ", wall " + replay::quantity(wish.wall, "mm")},
            {"material", "steel, " + replay::quantity(wish.yield * 1e6, "Pa")}};
        for (std::size_t i = 0; i < hinges_.size(); ++i) {
            const btVector3 in_a = along(starts_[i]);
            recorder.add({.name = "hinge " + std::to_string(i),
                          .a = recorder.number(bodies_[i].get()),
                          .b = i == 0 ? -1 : recorder.number(bodies_[i - 1].get()),
                          .in_a = {in_a.x(), in_a.y(), in_a.z()},
                          .facts = replay::facts_of(hinges_[i]->joint(), true, words)},
                         hinges_[i]->queries(), replay::life_used(*hinges_[i]));
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
            info.m_startWorldTransform.setOrigin(along(centre));
            auto& body = bodies_.emplace_back(std::make_unique<btRigidBody>(info));
            body->setActivationState(DISABLE_DEACTIVATION);
            if (!problem_.wish.loaded) {
                body->setAngularVelocity({0, spin, 0});
                body->setLinearVelocity({spin * centre, 0, 0});
            }
            engine_->addRigidBody(body.get(), 0, 0);
            starts_.push_back(low - centre);
        }
        for (int i = 0; i < rods; ++i) join(i, part);
    }
    /// The bar's way at the start [m].
    [[nodiscard]] btVector3 along(double far) const {
        return problem_.wish.loaded ? btVector3(far, 0, 0) : btVector3(0, 0, far);
    }
    void join(int i, double part) {
        const Wish& wish = problem_.wish;
        btRigidBody& above = *bodies_[std::size_t(i)];
        btRigidBody& below =
            i == 0 ? btTypedConstraint::getFixedBody() : *bodies_[std::size_t(i) - 1];
        const btTransform at(shortestArcQuat({0, 0, 1}, {0, 1, 0}), along(part * i));
        const btTransform in_above = above.getCenterOfMassTransform().inverse() * at;
        const btTransform in_below = below.getCenterOfMassTransform().inverse() * at;
        if (method_ == Method::ours) {
            auto& hinge =
                hinges_.emplace_back(std::make_unique<bullet::PlasticHinge<UsualAxisJoint>>(
                    above, below, in_above, in_below,
                    UsualAxisJoint(Perfect<double>({.strength = problem_.moment}),
                                   TravelLimit<double>({.limit = wish.largest}))));
            world_->add(*hinge, "hinge " + std::to_string(i));
            return;
        }
        const double impulse = problem_.moment * wish.frame; // of M_p over a step
        if (method_ == Method::motor) {
            auto hinge = std::make_unique<btHingeConstraint>(above, below, in_above, in_below);
            hinge->enableAngularMotor(true, 0, impulse);
            constraints_.push_back(std::move(hinge));
        } else {
            auto spring =
                std::make_unique<btGeneric6DofSpring2Constraint>(above, below, in_above, in_below);
            spring->setLinearLowerLimit({0, 0, 0});
            spring->setLinearUpperLimit({0, 0, 0});
            spring->setAngularLowerLimit({0, 0, 1}); // z is free: lower above upper
            spring->setAngularUpperLimit({0, 0, -1});
            spring->enableSpring(5, true);
            spring->setStiffness(
                5, youngs_modulus * problem_.section.second_moment(SectionAxis::x) / part);
            spring->setDamping(5, 0);
            spring->setEquilibriumPoint();
            spring->setBreakingImpulseThreshold(impulse);
            constraints_.push_back(std::move(spring));
        }
        engine_->addConstraint(constraints_.back().get());
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
            sum -= engine_->getGravity().z() * body->getCenterOfMassPosition().z() /
                   body->getInvMass();
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

class BarScene final : public Scene {
  public:
    [[nodiscard]] std::string name() const override { return "bar"; }
    [[nodiscard]] std::string about() const override {
        return "one bar three times: by this library, by Bullet's hinges with motors, by its "
               "springs";
    }
    [[nodiscard]] std::vector<Option> options() override {
        return {
            {"rods", "of the bar", "-", &wish_.rods, 1, 16, ""},
            {"length", "of the bar", "m", &wish_.length, 1, 10, ""},
            {"side", "of its box section", "mm", &wish_.side, 40, 300, ""},
            {"wall", "of its box section", "mm", &wish_.wall, 2, 20, ""},
            {"yield", "stress", "MPa", &wish_.yield, 100, 500, ""},
            {"mass", "on the tip", "kg", &wish_.mass, 1, 1000, ""},
            {"speed", "of the tip", "m/s", &wish_.speed, 1, 20, thrown},
            {"largest", "rotation of a hinge before it breaks", "rad", &wish_.largest, 0.05, 2, ""},
            {"iterations", "of Bullet's solver", "-", &wish_.iterations, 4, 1000, ""},
            {"direct", "1: Dantzig's solver instead", "-", &wish_.direct, 0, 1, ""}};
    }
    [[nodiscard]] std::vector<Part> parts() override {
        return {{thrown, [this](Run& run) { play(run, false); }},
                {"loaded by its weight", [this](Run& run) { play(run, true); }}};
    }

  private:
    void play(Run& run, bool loaded) const {
        Wish wish = wish_;
        wish.loaded = loaded;
        wish.rods = std::round(wish.rods);
        wish.frame = run.options().frame;
        wish.tolerance = run.options().tolerance;
        const Problem problem(wish);
        std::vector<std::unique_ptr<Bar>> bars;
        for (const Method method : methods) bars.push_back(std::make_unique<Bar>(problem, method));
        replay::Recorder recorder({.name = "bar: " + std::string(loaded ? "loaded" : thrown),
                                   .about = about(),
                                   .engine = "bullet",
                                   .rate = 60});
        for (const auto& bar : bars) bar->record(recorder);
        const double energy = problem.energy();
        const bool breaks = energy > problem.moment * wish.largest;
        const double taken = breaks ? problem.moment * wish.largest : energy;
        const double turn = taken / problem.moment;
        // until there is no more to see [s]
        const double end = loaded ? 3 : std::min(10.0, 0.3 + 4 * turn / (wish.speed / wish.length));
        for (long i = 1; double(i - 1) * wish.frame < end; ++i) {
            for (const auto& bar : bars) bar->step(wish.frame, double(i) * wish.frame);
            recorder.look(bars[0]->world());
            if (run.options().grows) run.options().grows(recorder);
        }
        run.tell("plastic moment", problem.moment, "N m");
        if (loaded) run.tell("of it used by the weight", problem.share());
        for (std::size_t i = 0; i < bars.size(); ++i) {
            const std::string of = std::string(names[i]) + ": ";
            const Bar& bar = *bars[i];
            if (loaded) {
                const bool stays = std::abs(bar.sag()) < 0.02 * wish.length;
                run.expect(of + "stands (1) or falls (0)", stays ? 1 : 0,
                           problem.share() < 1 ? 1 : 0, 0);
                run.tell(of + "its tip has sunk", bar.sag(), "m");
            } else if (breaks) {
                run.expect(of + "joints that broke", bar.broken(), 1, 0);
            } else {
                run.expect(of + "turn of the foot", bar.turn(), turn, 0.02, "rad");
            }
            if (!loaded) run.expect(of + "joints took", bar.taken(), taken, 0.02, "J");
            run.tell(of + "dearest frame", bar.cost(), "ms");
        }
        if (wish.tolerance > 0 && !bars[0]->world().run().believed()) run.doubt(names[0]);
        run.keep(loaded ? "loaded" : thrown, recorder);
    }

    static constexpr const char* thrown = "thrown";
    Wish wish_;
};

} // namespace

std::unique_ptr<Scene> bar_scene() { return std::make_unique<BarScene>(); }

} // namespace ductile::scenes
