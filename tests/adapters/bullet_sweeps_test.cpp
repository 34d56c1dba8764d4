// SPDX-License-Identifier: MIT
//
// Rows that a constraint solves by itself in the sweeps of Bullet's sequential impulse: the same
// answer as Bullet's own rows, in no more sweeps than it takes, and what Bullet tells the user of
// them.
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>

#include <malloc.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "adapters/bullet_world.hpp"
#include "ductile/bullet/suspect_solver.hpp"
#include "ductile/bullet/plastic_hinge.hpp"
#include "ductile/bullet/plastic_joint.hpp"
#include "ductile/bullet/soft_solvers.hpp"
#include "ductile/bullet/sweep_group.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

using One = OneAxisJoint<Perfect<double>>;
constexpr bool single = BulletWorld::single;

/// Has no rows and counts how often a solver calls it.
class SweepCounter final : public btTypedConstraint {
  public:
    explicit SweepCounter(btRigidBody& body) : btTypedConstraint(MAX_CONSTRAINT_TYPE, body) {}

    long sweeps = 0;

    void getInfo1(btConstraintInfo1* info) override {
        *info = {.m_numConstraintRows = 0, .nub = 0};
    }
    void getInfo2(btConstraintInfo2*) override {}
    void solveConstraintObsolete(btSolverBody&, btSolverBody&, btScalar) override { ++sweeps; }
    void setParam(int, btScalar, int) override {}
    [[nodiscard]] btScalar getParam(int, int) const override { return 0; }
};

/// A solver like Bullet's own, but not known to be: joints hand it their rows.
class UnknownSolver final : public btSequentialImpulseConstraintSolver {};

/// Boxes in a row, joined by hinges that flow and hold in turn, which fall and hit the ground.
class FallingRow {
  public:
    FallingRow(std::unique_ptr<btConstraintSolver> solver, int boxes, int iterations)
        : solver_(std::move(solver)) {
        world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
        world_.getSolverInfo().m_numIterations = iterations;
        add(0, btVector3(0, 0, -1), &ground_shape_);
        for (int i = 0; i < boxes; ++i) {
            btRigidBody& body =
                add(1 + btScalar(i) / 2, btVector3(btScalar(i), 0, btScalar(0.25)), &box_shape_);
            body.setAngularVelocity(btVector3(btScalar(0.3), i % 2 == 0 ? 1 : -2, btScalar(0.2)));
        }
        btTransform to_right, to_left;
        to_right.setBasis(btMatrix3x3(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI)));
        to_left.setBasis(to_right.getBasis());
        to_right.setOrigin(btVector3(btScalar(0.5), 0, 0));
        to_left.setOrigin(btVector3(btScalar(-0.5), 0, 0));
        for (std::size_t i = 1; i + 1 < bodies_.size(); ++i) {
            auto& hinge = *hinges_.emplace_back(std::make_unique<bullet::PlasticHinge<>>(
                *bodies_[i], *bodies_[i + 1], to_right, to_left,
                One(Perfect<double>({.strength = i % 2 == 0 ? 500.0 : 2.0}))));
            hinge.add_to(world_);
        }
        counter_ = std::make_unique<SweepCounter>(*bodies_[1]);
        world_.addConstraint(counter_.get());
    }
    ~FallingRow() {
        world_.removeConstraint(counter_.get());
        for (auto& hinge : hinges_) hinge->remove_from(world_);
        for (auto& body : bodies_) world_.removeRigidBody(body.get());
    }
    FallingRow(const FallingRow&) = delete;
    FallingRow& operator=(const FallingRow&) = delete;

    void step() { world_.stepSimulation(btScalar(1e-3), 0); }
    [[nodiscard]] int contacts() { return dispatcher_.getNumManifolds(); }
    [[nodiscard]] long sweeps() const { return counter_->sweeps; }
    [[nodiscard]] btContactSolverInfo& info() { return world_.getSolverInfo(); }
    /// Largest difference of the bodies' velocities [m/s | rad/s].
    [[nodiscard]] double difference(const FallingRow& other) const {
        double most = 0;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const btRigidBody &a = *bodies_[i], &b = *other.bodies_[i];
            most = std::max({most, double((a.getLinearVelocity() - b.getLinearVelocity()).length()),
                             double((a.getAngularVelocity() - b.getAngularVelocity()).length())});
        }
        return most;
    }

  private:
    btRigidBody& add(btScalar mass, const btVector3& at, btCollisionShape* shape) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        auto& body = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
        body.setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(&body);
        return body;
    }

    std::unique_ptr<btConstraintSolver> solver_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, solver_.get(), &configuration_};
    btBoxShape ground_shape_{btVector3(50, 50, 1)};
    btBoxShape box_shape_{btVector3(btScalar(0.4), btScalar(0.1), btScalar(0.2))};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<bullet::PlasticHinge<>>> hinges_;
    std::unique_ptr<SweepCounter> counter_;
};

using Stock = btSequentialImpulseConstraintSolver;

} // namespace

TEST_CASE("a constraint knows which solvers call it", "[bullet][sweeps]") {
    Stock stock;
    UnknownSolver unknown;
    btNNCGConstraintSolver conjugate;
    bullet::SuspectSolver before_stock(stock), before_unknown(unknown);
    btConstraintSolver& in_front = before_stock;
    bullet::SuspectSolver twice(in_front);
    CHECK(bullet::calls_in_each_sweep(stock));
    CHECK(bullet::calls_in_each_sweep(before_stock));
    CHECK(bullet::calls_in_each_sweep(twice));
    CHECK_FALSE(bullet::calls_in_each_sweep(unknown));
    CHECK_FALSE(bullet::calls_in_each_sweep(before_unknown));
    CHECK(bullet::calls_in_each_sweep(conjugate));
    bullet::SoftNncgSolver derived_of_conjugate; // honours compliance itself, and accelerates
    CHECK_FALSE(bullet::calls_in_each_sweep(derived_of_conjugate));

    class Derived final : public btDiscreteDynamicsWorld { // may have threads
      public:
        using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
    };
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btDiscreteDynamicsWorld plain(&dispatcher, &broadphase, &stock, &configuration);
    Derived derived(&dispatcher, &broadphase, &stock, &configuration);
    CHECK(bullet::solves_in_one_thread(plain));
    CHECK_FALSE(bullet::solves_in_one_thread(derived));
}

TEST_CASE("a joint of six axes that holds is solved in a few sweeps", "[bullet][sweeps]") {
    // a lever on the static world, pushed askew: its rows push each other, and all have bounds
    using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
    const bool elastic = GENERATE(false, true);
    INFO("elastic " << elastic);
    const auto stiffness =
        Vector6<double>::Constant(elastic ? 1e4 : std::numeric_limits<double>::infinity());
    BulletWorld world("si", {0, -9.81, 0});
    world.world().getSolverInfo().m_numIterations = 100;
    btRigidBody& body = world.body(2, {0.01, 0.2, 0.3}, BulletWorld::frame({0.5, 0.1, 0}));
    SweepCounter counter(body);
    world.world().addConstraint(&counter);
    bullet::PlasticJoint joint(
        body, BulletWorld::frame({-0.5, -0.1, 0}),
        Six(Ellipsoid<double, 6>({.capacity = Vector6<double>::Constant(1e3)}),
            Perfect<double>({.strength = 1}), TravelLimit<double>(), {.stiffness = stiffness}));
    joint.add_to(world.world());
    double worst = 0;
    for (int i = 0; i < 100; ++i) {
        body.applyTorque(btVector3(1, -2, 3));
        world.step(1e-2);
        worst = std::max({worst, joint.residual(), joint.rigid_residual()});
        CHECK(joint.outcome() == Outcome::elastic);
    }
    CHECK(worst < (single ? 1e-4 : 1e-11));
    CHECK(counter.sweeps < 100 * 6);
    joint.remove_from(world.world());
    world.world().removeConstraint(&counter);
}

TEST_CASE("rows that a joint solves by itself end where Bullet's do, in fewer sweeps",
          "[bullet][sweeps]") {
    const int boxes = GENERATE(2, 4);
    const std::string name = GENERATE(as<std::string>(), "si", "soft-si", "nncg");
    INFO(boxes << " boxes, " << name);
    constexpr int enough = 2000;
    std::unique_ptr<btConstraintSolver> solver = std::make_unique<Stock>();
    if (name == "soft-si") solver = std::make_unique<bullet::SoftSequentialImpulseSolver>();
    if (name == "nncg") solver = std::make_unique<btNNCGConstraintSolver>();
    FallingRow own(std::move(solver), boxes, enough);
    FallingRow engines(std::make_unique<UnknownSolver>(), boxes, enough);
    double apart = 0;
    int contacts = 0;
    for (int i = 0; i < 120; ++i) {
        own.step();
        engines.step();
        contacts = std::max(contacts, own.contacts());
        if (name == "nncg" && contacts > 0) break; // it has rows of its own then, and errs in them
        apart = std::max(apart, own.difference(engines));
    }
    CHECK(contacts > 0);
    CHECK(apart < (single ? 2e-2 : 1e-7));
    CHECK(own.sweeps() < engines.sweeps());
    if (boxes == 2 && !single) CHECK(own.sweeps() < engines.sweeps() / 2);
}

TEST_CASE("sweeps go on while a joint changes something, within the user's threshold",
          "[bullet][sweeps]") {
    const auto sweeps = [](double threshold, int most) {
        FallingRow row(std::make_unique<Stock>(), 4, most);
        row.info().m_leastSquaresResidualThreshold = btScalar(threshold);
        long of_each_step = 0;
        for (int i = 0; i < 20; ++i) { // before the ground is met
            row.step();
            CHECK(row.info().m_leastSquaresResidualThreshold == btScalar(threshold));
        }
        of_each_step = row.sweeps() / 20;
        return of_each_step;
    };
    const long exact = sweeps(0, 200), coarse = sweeps(1e-4, 200), cut = sweeps(0, 5);
    CHECK(exact > 10);
    CHECK(coarse > 1);
    CHECK(coarse < exact);
    CHECK(cut == 5);
    CHECK(sweeps(-1, 200) == 200); // the user wants them all
}

TEST_CASE("what Bullet tells of a joint's rows it tells of those that a joint solves by itself",
          "[bullet][sweeps]") {
    struct Told {
        btJointFeedback feedback; // a solver clears it
        double impulse = 0, angle = 0, residual = 0;
    };
    // a lever on an axis that is not its own, held by the static world and pushed askew; where it
    // is kept from moving along y, hinge and pivot both hold it, in shares that nothing decides
    const btVector3 moves = GENERATE(btVector3(1, 1, 1), btVector3(1, 0, 1));
    const btVector3 turns = GENERATE(btVector3(1, 1, 1), btVector3(0, 1, 1));
    const auto run = [&](btConstraintSolver& solver) {
        btDefaultCollisionConfiguration configuration;
        btCollisionDispatcher dispatcher(&configuration);
        btDbvtBroadphase broadphase;
        btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
        world.setGravity(btVector3(0, 0, 0));
        world.getSolverInfo().m_numIterations = 2000;
        btSphereShape shape(1);
        // Bullet's own torques leave an axis that may not turn unless the body is alike about all
        const btVector3 inertia = turns.x() == 0 ? btVector3(2, 2, 2) : btVector3(1, 2, 3);
        btRigidBody body(btRigidBody::btRigidBodyConstructionInfo(2, nullptr, &shape, inertia));
        body.setActivationState(DISABLE_DEACTIVATION);
        body.setLinearFactor(moves);
        body.setAngularFactor(turns);
        world.addRigidBody(&body);
        Told told;
        {
            btTransform frame;
            frame.setIdentity();
            frame.setOrigin(btVector3(btScalar(-0.5), btScalar(0.25), 0));
            bullet::PlasticHinge<> hinge(body, frame, One(Perfect<double>({.strength = 1.5})));
            hinge.setJointFeedback(&told.feedback);
            hinge.add_to(world);
            for (int i = 0; i < 50; ++i) {
                body.applyCentralForce(btVector3(3, 4, -2));
                body.applyTorque(btVector3(1, -2, 2));
                world.stepSimulation(btScalar(0.01), 0);
            }
            told.impulse = double(hinge.getAppliedImpulse());
            told.angle = hinge.rotation();
            told.residual = std::max(hinge.residual(), hinge.rigid_residual());
            hinge.remove_from(world);
        }
        world.removeRigidBody(&body);
        return told;
    };
    Stock stock;
    btNNCGConstraintSolver conjugate;
    UnknownSolver unknown;
    const bool nncg = GENERATE(false, true);
    const Told own = nncg ? run(conjugate) : run(stock), engines = run(unknown);
    const double tolerance = single ? 1e-3 : 1e-8;
    CHECK(own.residual < tolerance);
    CHECK(own.angle == Approx(engines.angle).epsilon(tolerance).margin(tolerance));
    if (moves.y() == 0) {
        CHECK(std::abs(own.angle) < tolerance);
        return;
    }
    CHECK(std::abs(own.angle) > 0.01);
    CHECK(own.impulse == Approx(engines.impulse).epsilon(tolerance).margin(tolerance));
    const std::array mine{own.feedback.m_appliedForceBodyA, own.feedback.m_appliedTorqueBodyA,
                          own.feedback.m_appliedForceBodyB, own.feedback.m_appliedTorqueBodyB};
    const std::array theirs{
        engines.feedback.m_appliedForceBodyA, engines.feedback.m_appliedTorqueBodyA,
        engines.feedback.m_appliedForceBodyB, engines.feedback.m_appliedTorqueBodyB};
    CHECK(double(theirs[0].length()) > 0.1);
    for (std::size_t i = 0; i < mine.size(); ++i) {
        INFO("entry " << i);
        CHECK(double((mine[i] - theirs[i]).length()) < 10 * tolerance);
    }
}

TEST_CASE("joints that leave a world and come back share its sweeps again", "[bullet][sweeps]") {
    BulletWorld world("si");
    world.world().getSolverInfo().m_numIterations = 100;
    btRigidBody &a = world.body(1, 1), &b = world.body(1, 1, {1, 0, 0}),
                &c = world.body(1, 1, {2, 0, 0});
    const auto right = BulletWorld::frame({0.5, 0, 0}), left = BulletWorld::frame({-0.5, 0, 0});
    bullet::PlasticHinge<> first(a, b, right, left, One(Perfect<double>({.strength = 1e3})));
    bullet::PlasticHinge<> second(b, c, right, left, One(Perfect<double>({.strength = 1e3})));
    const auto solved = [&] {
        c.setLinearVelocity(btVector3(0, 1, 0));
        world.step(1e-3);
        return first.residual() + first.rigid_residual() + second.residual() +
               second.rigid_residual();
    };
    first.add_to(world.world());
    second.add_to(world.world());
    CHECK(solved() < (single ? 1e-5 : 1e-12));
    first.remove_from(world.world());
    world.step(1e-3);
    first.add_to(world.world());
    CHECK(solved() < (single ? 1e-5 : 1e-12));
    CHECK(world.world().getSolverInfo().m_leastSquaresResidualThreshold == 0);
    first.remove_from(world.world());
    second.remove_from(world.world());
}

TEST_CASE("a hinge that has bent is solved in about as few sweeps as a new one",
          "[bullet][sweeps]") {
    BulletWorld world("si");
    btRigidBody& lever = world.body(2, {0.1, 1.5, 2}, BulletWorld::frame({0.5, 0, 0}));
    btRigidBody& base = world.body(3, {0.2, 0.9, 0.5}, BulletWorld::frame({0, -0.4, 0.3}));
    bullet::PlasticHinge<> hinge(lever, base, BulletWorld::frame({-0.5, 0, 0}),
                                 BulletWorld::frame({0, 0.4, -0.3}),
                                 One(Perfect<double>({.strength = 8})));
    hinge.add_to(world.world());
    SweepCounter counter(lever);
    world.world().addConstraint(&counter);
    const auto sweeps_while_it_holds = [&] {
        counter.sweeps = 0;
        for (int i = 0; i < 20; ++i) {
            lever.applyTorque(btVector3(1, -2, 0));
            world.step(1e-3);
            REQUIRE(hinge.outcome() == Outcome::elastic);
        }
        return counter.sweeps;
    };
    const long fresh = sweeps_while_it_holds();
    CHECK(fresh <= 3 * 20);
    lever.setAngularVelocity(btVector3(0, 0, 8));
    for (int i = 0; i < 2000 && hinge.plastic_rotation() < 0.5; ++i) world.step(1e-3);
    REQUIRE(hinge.plastic_rotation() > 0.5);
    for (btRigidBody* body : {&lever, &base}) {
        body->setLinearVelocity(btVector3(0, 0, 0));
        body->setAngularVelocity(btVector3(0, 0, 0));
    }
    world.step(1e-3, 5);
    CHECK(sweeps_while_it_holds() <= 2 * fresh); // twelve times as many with the rows it had new
    world.world().removeConstraint(&counter);
    hinge.remove_from(world.world());
}

TEST_CASE("a body that may not turn about a hinge's axis does not swing", "[bullet][sweeps]") {
    const std::string solver = GENERATE("si", "soft-si");
    BulletWorld world(solver, {0, 0, -9.81});
    btRigidBody& body = world.body(2, 0.5, {0.5, 0, 0});
    body.setAngularFactor(btVector3(1, 0, 1));
    Matrix3<double> axes; // z about the world's y
    axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    bullet::PlasticHinge<> hinge(body, BulletWorld::frame({-0.5, 0, 0}, axes),
                                 One(Perfect<double>({.strength = 1e-3})));
    hinge.add_to(world.world());
    world.step(0.01, 100);
    CHECK(std::abs(hinge.rotation()) < 1e-6);
    CHECK(std::abs(double(body.getCenterOfMassPosition().z())) < 1e-6);
    CHECK(hinge.outcome() != Outcome::unreliable);
    hinge.remove_from(world.world());
}

TEST_CASE("every solve uses the same room for rows, also where it makes no sweep",
          "[bullet][sweeps]") {
    const std::string solver = GENERATE("si", "soft-si");
    const int iterations = GENERATE(0, 20);
    INFO(solver << ", " << iterations << " iterations");
    BulletWorld world(solver);
    world.world().getSolverInfo().m_numIterations = iterations;
    btRigidBody &a = world.body(1, 1), &b = world.body(1, 1, {1, 0, 0});
    btRigidBody &c = world.body(1, 1, {5, 0, 0}), &d = world.body(1, 1, {6, 0, 0}); // an island
    const auto right = BulletWorld::frame({0.5, 0, 0}), left = BulletWorld::frame({-0.5, 0, 0});
    const One strong(Perfect<double>({.strength = 1e3}));
    bullet::PlasticHinge<> first(a, b, right, left, strong), second(c, d, right, left, strong);
    first.add_to(world.world());
    second.add_to(world.world());
    world.step(1e-3, 10);
    const auto before = mallinfo2().uordblks;
    world.step(1e-3, 1000);
    CHECK(mallinfo2().uordblks < before + sizeof(RowSweep<double>));
    world.world().getSolverInfo().m_numIterations = 20;
    for (btRigidBody* body : {&b, &d}) body->setLinearVelocity(btVector3(0, 1, 0));
    world.step(1e-3);
    for (auto* hinge : {&first, &second}) {
        CHECK(hinge->rigid_residual() < (single ? 1e-5 : 1e-12));
        hinge->remove_from(world.world());
    }
}
