// SPDX-License-Identifier: MIT
//
// What happens to bodies and joints in a real world: sleeping and waking, hands that move bodies,
// kinematic bodies, joints switched off and on, bodies and constraints taken away, states restored.
#include "adapters/ode_rig.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double exact = 1e-9;
const V3 none = V3::Zero(), z(0, 0, 1);
const double dt = 1.0 / 240;

V3 sphere(double i) { return V3::Constant(i); }
Joint joint(double strength, double limit = infinity, double stiffness = infinity) {
    return Joint(Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = limit}),
                 {.stiffness = stiffness});
}

void let_sleep(dBodyID body) {
    dBodySetAutoDisableFlag(body, 1);
    dBodySetAutoDisableLinearThreshold(body, 0.05);
    dBodySetAutoDisableAngularThreshold(body, 0.05);
    dBodySetAutoDisableSteps(body, 10);
    dBodySetAutoDisableTime(body, 0);
}
bool asleep(dBodyID body) { return dBodyIsEnabled(body) == 0; }

void turn(dBodyID body, double angle) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, z));
    const dReal values[4] = {q.w(), q.x(), q.y(), q.z()};
    dBodySetQuaternion(body, values);
}
void turn_by(dBodyID body, double angle) {
    const dReal* q = dBodyGetQuaternion(body);
    const Eigen::Quaterniond now(q[0], q[1], q[2], q[3]);
    const Eigen::Quaterniond next = Eigen::Quaterniond(Eigen::AngleAxisd(angle, z)) * now;
    const dReal values[4] = {next.w(), next.x(), next.y(), next.z()};
    dBodySetQuaternion(body, values);
}
void spin(dBodyID body, double speed) { dBodySetAngularVel(body, 0, 0, speed); }
/// ODE's own hinge about z, to the static world.
dJointID pin(const Rig& rig, dBodyID body) {
    const dJointID id = dJointCreateHinge(rig.world(), nullptr);
    dJointAttach(id, body, nullptr);
    dJointSetHingeAnchor(id, 0, 0, 0);
    dJointSetHingeAxis(id, 0, 0, 1);
    return id;
}

} // namespace

TEST_CASE("a loaded hinge sleeps and wakes without yielding or gaining", "[ode][life]") {
    // a bar of 2 kg held level at its end, 20 N m at the root; rigid, and elastic with bounds that
    // differ
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double stiffness = GENERATE(as<double>{}, infinity, 1e6, 2e3);
    INFO(solver << ", k = " << stiffness);
    Rig rig(solver, {0, -10, 0});
    auto bar = rig.body(2, sphere(0.5), {1, 0, 0}, none, none);
    auto& hinge = rig.hinge_of(bar, nullptr, none, z, joint(30, infinity, stiffness));
    rig.open_ledger();
    dWorldSetLinearDamping(rig.world(), 0);
    // a spring would swing for ever: it is brought to rest by hand
    for (int i = 0; i < 1500; ++i) {
        rig.step(dt);
        Rig::set_velocity(bar, none);
        spin(bar, 0);
    }
    let_sleep(bar);
    int steps = 0;
    while (!asleep(bar) && ++steps < 200) rig.step(dt);
    REQUIRE(asleep(bar));
    const double held = hinge.moment(), stored = hinge.stored_energy(), turned = hinge.rotation();
    const double offset = hinge.plastic_offset();
    CHECK(std::abs(rig.ledger().unexplained()) < exact);
    for (int i = 0; i < 100; ++i) rig.step(dt);
    CHECK(hinge.moment() == held); // it still holds
    CHECK(hinge.rotation() == turned);
    CHECK(hinge.stored_energy() == stored);
    CHECK(hinge.plastic_offset() == offset);
    CHECK(hinge.plastic_rotation() == 0);
    CHECK(std::abs(rig.ledger().unexplained()) < exact);
    // nothing piled up while it slept
    CHECK(ode::to_core(dBodyGetForce(bar)).norm() == 0);
    CHECK(ode::to_core(dBodyGetTorque(bar)).norm() == 0);
    dBodySetAutoDisableFlag(bar, 0);
    dBodyEnable(bar);
    rig.step(dt);
    // awake it goes on from where it was
    CHECK(hinge.rotation() == Approx(turned).margin(1e-3));
    CHECK(hinge.plastic_rotation() == 0);
    CHECK(std::abs(rig.ledger().unexplained()) < exact);
}

TEST_CASE("the force given for a step is taken back where the bodies fall asleep in it",
          "[ode][life]") {
    // a motor with a resolved spring gives its force from outside; ODE decides within the step who
    // sleeps
    Rig rig("direct", none);
    auto rotor = rig.body(1, sphere(2), none, none, none);
    const dJointID free = pin(rig, rotor);
    auto& hinge = rig.motor(ode::hinge_axis(free), joint(1e3, infinity, 200));
    let_sleep(rotor);
    turn(rotor, 0.0);
    spin(rotor, 0.004); // below the threshold
    for (int i = 0; i < 40; ++i) rig.step(dt);
    REQUIRE(asleep(rotor));
    CHECK(std::abs(hinge.reaction()) > 1e-3);
    CHECK(ode::to_core(dBodyGetTorque(rotor)).norm() == 0);
    CHECK(Rig::spin(rotor).norm() == 0);
    // woken, it swings with what was stored and no more
    const double stored = hinge.stored_energy();
    dBodySetAutoDisableFlag(rotor, 0);
    dBodyEnable(rotor);
    double fastest = 0;
    for (int i = 0; i < 400; ++i) {
        rig.step(dt);
        fastest = std::max(fastest, std::abs(Rig::spin(rotor).z()));
    }
    CHECK(fastest == Approx(std::sqrt(stored)).epsilon(0.03)); // I ω²/2 with I = 2
    CHECK(std::abs(rig.ledger().unexplained()) < exact);
}

TEST_CASE("a joint of six axes takes back what it gave where the bodies fall asleep",
          "[ode][life][six]") {
    // in an island of its own, and in one that a joint of ODE's keeps with ODE
    const bool pinned = GENERATE(false, true);
    INFO((pinned ? "with" : "without") << " a hinge of ODE's own");
    using Six = CoupledJoint<Ellipsoid<double, 6>, Perfect<double>>;
    Rig rig("direct", none);
    auto rotor = rig.body(1, sphere(2), none, none, none);
    if (pinned) rig.pin(rotor, nullptr, none, z);
    auto& six = rig.six_axis(rotor, nullptr, JointFrame<double>{},
                             Six(Ellipsoid<double, 6>({.capacity = Vector6<double>::Constant(1e3)}),
                                 Perfect<double>({.strength = 1}), TravelLimit<double>(),
                                 {.stiffness = Vector6<double>::Constant(200)}));
    let_sleep(rotor);
    spin(rotor, 0.004); // below the threshold
    for (int i = 0; i < 400; ++i) rig.step(dt);
    REQUIRE(asleep(rotor));
    CHECK(std::abs(six.force(JointAxis::torsion)) > 1e-4);
    CHECK(ode::to_core(dBodyGetTorque(rotor)).norm() == 0);
    CHECK(Rig::spin(rotor).norm() == 0);
    // woken, it swings with what was stored and no more
    const double stored = six.stored_energy();
    dBodySetAutoDisableFlag(rotor, 0);
    dBodyEnable(rotor);
    double fastest = 0;
    for (int i = 0; i < 200; ++i) {
        rig.step(dt);
        fastest = std::max(fastest, std::abs(Rig::spin(rotor).z()));
    }
    CHECK(fastest == Approx(std::sqrt(stored)).epsilon(0.03)); // I ω²/2 with I = 2
    CHECK(std::abs(rig.ledger().unexplained()) < exact);
}

TEST_CASE("the certificate of a motor's pin is the speed that the solver left between its halves",
          "[ode][life]") {
    // struck beside its hinge, with one sweep of an iterative solver
    Rig rig("quick", none);
    rig.set_iterations(1);
    dWorldSetERP(rig.world(), 0); // no row asks for a speed
    const V3 at(1, 0.2, -0.1);
    auto bar = rig.body(2, V3(0.1, 0.5, 0.3), at, none, none);
    rig.leave_to_ode(bar);
    const dJointID free = pin(rig, bar);
    auto& hinge = rig.motor(ode::hinge_axis(free), joint(30));
    Rig::apply_force(bar, V3(100, -200, 300));
    Rig::apply_torque(bar, V3(40, 50, 60));
    rig.step(dt);
    const V3 turn = Rig::spin(bar), left = Rig::velocity(bar) - turn.cross(at);
    const double worst = left.cwiseAbs().maxCoeff();
    CHECK(worst > 1e-3);
    CHECK(hinge.rigid_residual() == Approx(worst).epsilon(1e-9));
}

TEST_CASE("a sleeping pair wakes when a third body that hangs on it moves", "[ode][life]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Rig rig(solver, none);
    auto a = rig.body(1, sphere(2), none, none, none);
    auto b = rig.body(1, sphere(2), none, none, none);
    auto c = rig.body(1, sphere(2), none, none, none);
    auto& first = rig.hinge(b, a, none, z, joint(10));
    auto& second = rig.hinge(c, b, none, z, joint(20));
    rig.open_ledger();
    for (auto body : {a, b, c}) let_sleep(body);
    for (int i = 0; i < 40; ++i) rig.step(dt);
    REQUIRE((asleep(a) && asleep(b) && asleep(c)));
    // ODE does not start a woken body's count afresh and would stop it again in the next step
    for (auto body : {a, b, c}) dBodySetAutoDisableAngularThreshold(body, 1e-9);
    spin(c, 12);
    dBodyEnable(c);
    rig.step(dt);
    CHECK(!asleep(a));
    CHECK(second.moment() == Approx(-20).epsilon(solver == "quick" ? 1e-3 : exact));
    for (int i = 0; i < 600; ++i) rig.step(dt);
    // all at a third of the speed: 96 J of 144 J taken by the two hinges
    const double tolerance = solver == "quick" ? 1e-3 : 1e-6;
    for (auto body : {a, b, c}) CHECK(Rig::spin(body).z() == Approx(4).epsilon(tolerance));
    CHECK(first.absorbed_energy() + second.absorbed_energy() == Approx(96).epsilon(tolerance));
    CHECK(std::abs(rig.ledger().unexplained()) < exact * 144);
}

namespace {

/// I = 2 kg m², M_p = 40 N m, from 10 rad/s; two of them go through the same but for what is
/// tested.
struct Braked {
    explicit Braked(double stiffness) {
        rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
        hinge = &rig.hinge_of(rotor, nullptr, none, z, joint(40, infinity, stiffness));
        rig.open_ledger();
    }
    Rig rig{"direct", none};
    Rig::Body rotor = nullptr;
    ode::PlasticHinge<>* hinge = nullptr;

    /// All but where it is; energies and what the joint remembers.
    void same_as(const Braked& other) const {
        CHECK(Rig::spin(rotor).z() == Approx(Rig::spin(other.rotor).z()).margin(exact));
        CHECK(hinge->moment() == Approx(other.hinge->moment()).margin(1e-7));
        CHECK(hinge->absorbed_energy() ==
              Approx(other.hinge->absorbed_energy()).margin(exact * 100));
        CHECK(hinge->stored_energy() == Approx(other.hinge->stored_energy()).margin(exact));
        CHECK(hinge->plastic_rotation() == Approx(other.hinge->plastic_rotation()).margin(exact));
        CHECK(hinge->rotation() - hinge->plastic_offset() ==
              Approx(other.hinge->rotation() - other.hinge->plastic_offset()).margin(exact));
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100);
    }
};

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

} // namespace

TEST_CASE("bodies moved by hand do not deform the joint", "[ode][life]") {
    const double stiffness = GENERATE(as<double>{}, infinity, 2e3);
    const double by = GENERATE(0.3, 3.0, -7.0);
    INFO("k = " << stiffness << ", turned by " << by);
    Braked moved(stiffness), twin(stiffness);
    double hands = 0;
    for (int i = 0; i < 300; ++i) {
        if (i == 60 || i == 200) { // while it flows, and when it has stopped or swings
            turn_by(moved.rotor, by);
            hands += by;
        }
        moved.rig.step(dt);
        twin.rig.step(dt);
        if (i == 60 || i == 61) moved.same_as(twin);
    }
    moved.same_as(twin);
    // it is where it was put, and so is its rest position
    CHECK(wrapped(moved.hinge->rotation() - twin.hinge->rotation() - hands) ==
          Approx(0).margin(exact));
    CHECK(wrapped(moved.hinge->plastic_offset() - twin.hinge->plastic_offset() - hands) ==
          Approx(0).margin(exact));
}

TEST_CASE("a joint that is switched off does nothing and goes on from where its bodies are",
          "[ode][life]") {
    const double stiffness = GENERATE(as<double>{}, infinity, 2e3);
    INFO("k = " << stiffness);
    Braked paused(stiffness), twin(stiffness);
    for (int i = 0; i < 24; ++i) {
        paused.rig.step(dt);
        twin.rig.step(dt);
    }
    const double force = paused.hinge->moment();
    dJointDisable(paused.hinge->id());
    for (int i = 0; i < 100; ++i) {
        paused.rig.step(dt);
        CHECK(paused.hinge->moment() == 0);
        CHECK(paused.hinge->outcome() == Outcome::elastic);
    }
    CHECK(force == Approx(-40).epsilon(exact));
    CHECK(paused.hinge->absorbed_energy() == twin.hinge->absorbed_energy());
    CHECK(paused.hinge->stored_energy() == twin.hinge->stored_energy());
    CHECK(Rig::spin(paused.rotor) == Rig::spin(twin.rotor));
    dJointEnable(paused.hinge->id());
    for (int i = 0; i < 150; ++i) {
        paused.rig.step(dt);
        twin.rig.step(dt);
        if (i == 0) paused.same_as(twin);
    }
    paused.same_as(twin);
}

TEST_CASE("a body made kinematic drives the joint, and two of them leave it alone", "[ode][life]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Rig rig(solver, none);
    auto driver = rig.body(1, sphere(2), none, none, none);
    auto rotor = rig.body(1, sphere(2), none, none, none);
    auto& hinge = rig.hinge(rotor, driver, none, z, joint(40));
    for (int i = 0; i < 5; ++i) rig.step(dt);
    dBodySetKinematic(driver);
    spin(driver, -10); // the rotor is dragged along with 20 rad/s²
    rig.step(dt);
    CHECK(hinge.moment() == Approx(-40).epsilon(exact));
    CHECK(Rig::spin(rotor).z() == Approx(-20 * dt).epsilon(exact));
    for (int i = 0; i < 150; ++i) rig.step(dt);
    CHECK(Rig::spin(rotor).z() == Approx(-10).epsilon(exact));
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(exact)); // as seen from the driver
    CHECK(hinge.plastic_rotation() == Approx(2.5).epsilon(exact));

    dBodySetKinematic(rotor);
    spin(rotor, 3);
    for (int i = 0; i < 50; ++i) rig.step(dt);
    CHECK(Rig::spin(rotor).z() == 3);
    CHECK(hinge.moment() == 0);
    CHECK(hinge.absorbed_energy() == Approx(100).epsilon(exact));

    dBodySetDynamic(rotor); // 13 rad/s relative, from where it is now
    for (int i = 0; i < 200; ++i) rig.step(dt);
    CHECK(Rig::spin(rotor).z() == Approx(-10).epsilon(exact));
    CHECK(hinge.absorbed_energy() == Approx(100 + 169).epsilon(exact));
}

TEST_CASE("a body that is destroyed leaves a constraint that does nothing", "[ode][life]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const bool second = GENERATE(false, true);
    INFO(solver << (second ? ", the second" : ", the first"));
    Rig rig(solver, none);
    auto a = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto b = rig.body(1, sphere(3), none, none, none);
    auto& hinge = rig.hinge(a, b, none, z, joint(12));
    // and a motor of the user's joint between the same two
    const dJointID wheel = dJointCreateUniversal(rig.world(), nullptr);
    dJointAttach(wheel, a, b);
    dJointSetUniversalAxis1(wheel, 0, 0, 1);
    dJointSetUniversalAxis2(wheel, 1, 0, 0);
    auto& motor = rig.motor(ode::universal_axis(wheel, 0), joint(5));
    rig.open_ledger();
    for (int i = 0; i < 20; ++i) rig.step(dt);
    const double absorbed = hinge.absorbed_energy();
    CHECK(absorbed > 0);
    CHECK(!hinge.detached());
    auto left = second ? a : b;
    const V3 speed = Rig::spin(left);
    rig.destroy(second ? b : a);
    for (int i = 0; i < 20; ++i) rig.step(dt);
    CHECK(hinge.detached());
    CHECK(motor.detached());
    CHECK(hinge.moment() == 0);
    CHECK(motor.reaction() == 0);
    CHECK(hinge.absorbed_energy() == absorbed);
    CHECK(!hinge.broken());
    CHECK((Rig::spin(left) - speed).norm() < 1e-12);
    rig.remove(motor);
    rig.step(dt);
}

TEST_CASE("a joint attached anew is no longer this constraint's", "[ode][life]") {
    Rig rig("direct", none);
    auto a = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto b = rig.body(1, sphere(3), none, none, none);
    const dJointID hinge = dJointCreateHinge(rig.world(), nullptr);
    dJointAttach(hinge, a, nullptr);
    dJointSetHingeAxis(hinge, 0, 0, 1);
    auto& motor = rig.motor(ode::hinge_axis(hinge), joint(12));
    rig.step(dt);
    dJointAttach(hinge, a, b);
    rig.step(dt);
    CHECK(motor.detached());
    CHECK(motor.reaction() == 0);
}

TEST_CASE("a constraint taken away lets its bodies go", "[ode][life]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver);
    Rig rig(solver, none);
    auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto& hinge = rig.hinge_of(rotor, nullptr, none, z, joint(40));
    for (int i = 0; i < 24; ++i) rig.step(dt);
    const double speed = Rig::spin(rotor).z();
    CHECK(speed == Approx(8).epsilon(exact));
    rig.remove(hinge);
    CHECK(dBodyGetNumJoints(rotor) == 0);
    for (int i = 0; i < 24; ++i) rig.step(dt);
    CHECK(Rig::spin(rotor).z() == speed);
}

TEST_CASE("a restored run goes on bit for bit", "[ode][life]") {
    const double stiffness = GENERATE(as<double>{}, infinity, 2e3);
    const bool bodies_first = GENERATE(true, false);
    const bool summed_up = GENERATE(false, true); // an angular motor: no angle of ODE's own
    INFO("k = " << stiffness << (bodies_first ? ", bodies first" : ", joint first"));
    struct Saved {
        Joint::State state;
        double position;
        dQuaternion turned;
        dVector3 speed;
    };
    Rig rig("direct", none);
    auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 30});
    const dJointID id = summed_up ? dJointCreateAMotor(rig.world(), nullptr)
                                  : dJointCreateHinge(rig.world(), nullptr);
    dJointAttach(id, rotor, nullptr);
    if (summed_up) {
        dJointSetAMotorNumAxes(id, 1);
        dJointSetAMotorAxis(id, 0, 1, 0, 0, 1);
    } else {
        dJointSetHingeAxis(id, 0, 0, 1);
    }
    auto& hinge = rig.motor(summed_up ? ode::angular_motor_axis(id, 0) : ode::hinge_axis(id),
                            joint(40, infinity, stiffness));
    const auto after = [&] {
        for (int i = 0; i < 300; ++i) rig.step(dt);
        return std::vector<double>{hinge.position(), hinge.plastic_offset(),
                                   hinge.absorbed_energy(), Rig::spin(rotor).z(),
                                   dBodyGetQuaternion(rotor)[0]};
    };
    for (int i = 0; i < 100; ++i) rig.step(dt); // two turns on
    Saved saved{hinge.joint().state(), hinge.position(), {}, {}};
    for (int i = 0; i < 4; ++i) saved.turned[i] = dBodyGetQuaternion(rotor)[i];
    for (int i = 0; i < 3; ++i) saved.speed[i] = dBodyGetAngularVel(rotor)[i];
    CHECK(saved.position > 6);
    const auto put_back = [&] {
        const auto bodies = [&] {
            dBodySetQuaternion(rotor, saved.turned);
            dBodySetAngularVel(rotor, saved.speed[0], saved.speed[1], saved.speed[2]);
        };
        if (bodies_first) bodies();
        hinge.restore(saved.state, saved.position);
        if (!bodies_first) bodies();
    };
    // ODE normalises a quaternion that it is given, which changes its last bit: so in both runs
    put_back();
    const std::vector<double> first = after();
    put_back();
    CHECK(after() == first);
}

TEST_CASE("a restored broken joint is broken", "[ode][life]") {
    Rig rig("direct", none);
    auto rotor = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto& hinge = rig.hinge_of(rotor, nullptr, none, z, joint(40, 0.5));
    while (!hinge.broken()) rig.step(dt);
    const auto state = hinge.state();
    auto other = rig.body(1, sphere(2), none, none, {0, 0, 10});
    auto& again = rig.hinge_of(other, nullptr, none, z, joint(40, 0.5));
    again.restore(state);
    CHECK(again.broken());
    for (int i = 0; i < 10; ++i) rig.step(dt);
    CHECK(Rig::spin(other).z() == 10);
}

TEST_CASE("very light and very heavy bodies hinge as well", "[ode][life]") {
    const double size = GENERATE(1e-6, 1e-3, 1e6);
    const double stiffness = GENERATE(as<double>{}, infinity, 2e3);
    const auto solver = GENERATE(from_range(Rig::solvers()));
    INFO(solver << ", I = " << 2 * size << ", k = " << stiffness << " × size");
    const auto absorbed_per_size = [&](double scale) {
        Rig rig(solver, none);
        auto rotor = rig.body(scale, sphere(2 * scale), none, none, {0, 0, 10});
        auto& hinge =
            rig.hinge_of(rotor, nullptr, none, z, joint(40 * scale, infinity, stiffness * scale));
        rig.open_ledger();
        for (int i = 0; i < 150; ++i) rig.step(dt);
        CHECK(std::abs(rig.ledger().unexplained()) < exact * 100 * scale);
        return hinge.absorbed_energy() / scale;
    };
    CHECK(absorbed_per_size(size) == Approx(absorbed_per_size(1)).epsilon(1e-8));
    CHECK(absorbed_per_size(size) > 99);
}
