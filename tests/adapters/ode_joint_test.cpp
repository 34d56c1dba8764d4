// SPDX-License-Identifier: MIT
//
// The joint of six axes in ODE: what only this engine has. Ties of its direct solver, kinematic and
// sleeping bodies, broken and detached joints, saved state, bad input.
#include "adapters/ode_rig.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <limits>
#include <string>
#include <vector>

#include "adapters/six_axis.hpp"
#include "ductile/ode/point_rows.hpp"
#include "support/throws.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

/// Counts what ODE complains about while it lives.
class Complaints {
  public:
    Complaints() {
        count_ = 0;
        dSetMessageHandler(&count);
    }
    ~Complaints() { dSetMessageHandler(nullptr); }
    Complaints(const Complaints&) = delete;
    Complaints& operator=(const Complaints&) = delete;
    [[nodiscard]] static int seen() { return count_; }

  private:
    static void count(int, const char*, std::va_list) { ++count_; }
    inline static int count_ = 0;
};

/// A beam of equal segments along x from wall to wall, each end and each node a joint of six axes.
struct ClampedBeam {
    ClampedBeam(Rig& rig, int segments, double length, double mass, const V6& capacity) {
        const double part = length / segments, inertia = mass / segments * part * part / 12;
        for (int i = 0; i < segments; ++i) {
            bodies.push_back(rig.body(mass / segments, {inertia / 50, inertia, inertia},
                                      {(i + 0.5) * part, 0, 0}, none, none));
        }
        for (int i = 0; i <= segments; ++i) {
            const Frame frame{{i * part, 0, 0}, along({1, 0, 0})};
            const bool last = i == segments;
            joints.push_back(&rig.six_axis(bodies[std::size_t(last ? i - 1 : i)],
                                           i == 0 || last ? nullptr : bodies[std::size_t(i - 1)],
                                           frame, six(capacity)));
        }
    }
    /// Load on the node between segments i - 1 and i, carried by both in equal parts [N]. The beam
    /// is straight.
    void push(std::size_t i, const V3& force) const {
        for (const std::size_t k : {i - 1, i}) {
            const double part = 2 * Rig::position(bodies[0]).x();
            const V3 arm(k == i ? -part / 2 : part / 2, 0, 0);
            Rig::apply_force(bodies[k], force / 2);
            Rig::apply_torque(bodies[k], arm.cross(V3(force / 2)));
        }
    }

    std::vector<dBodyID> bodies;
    std::vector<ode::PlasticJoint<Six>*> joints;
};

} // namespace

TEST_CASE("a beam clamped at both ends stands still below its collapse load and moves above",
          "[six]") {
    // M_p = 100 N m, segments of 1 m, weightless: P_c = 8 M_p/L at mid-span. More rows than the
    // bodies have freedoms, and left and right alike: every tie that a direct solver can meet.
    const int segments = GENERATE(2, 4, 8);
    const double share = GENERATE(0.95, 1.5);
    INFO(segments << " segments, " << share << " of the collapse load");
    const double length = segments, mass = 4.0 * segments, moment = 100;
    V6 capacity;
    capacity << 1e6, 1e6, 1e6, moment, moment, moment;
    Complaints complaints;
    Rig rig("direct", none);
    const ClampedBeam beam(rig, segments, length, mass, capacity);
    const double load = share * 8 * moment / length;
    const int steps = share < 1 ? 500 : 1;
    const double dt = 1e-3;
    for (int i = 0; i < steps; ++i) {
        beam.push(std::size_t(segments / 2), {0, 0, -load});
        rig.step(dt);
    }
    CHECK(Complaints::seen() == 0);
    const double speed = Rig::spin(beam.bodies[0]).y();
    if (share < 1) {
        CHECK(std::abs(speed) < 1e-9);
        CHECK(Rig::position(beam.bodies[0]).norm() == Approx(0.5).epsilon(1e-9));
        double up = 0;
        for (const auto* joint : {beam.joints.front(), beam.joints.back()}) {
            CHECK(joint->absorbed_energy() == 0);
            CHECK(joint->outcome() == Outcome::elastic);
            const V3 force(joint->force(JointAxis::shear_x), joint->force(JointAxis::shear_y),
                           joint->force(JointAxis::axial));
            up += (joint->link().axes_in_world() * force).z();
        }
        CHECK(up == Approx(load).epsilon(exact));
    } else {
        // each half is a rod about its wall: (P/2)(L/2) - 2 M_p over (m/2)(L/2)²/3
        const double half = length / 2;
        const double expected = (load / 2 * half - 2 * moment) / (mass / 2 * half * half / 3);
        CHECK(speed / dt == Approx(expected).epsilon(1e-6));
    }
}

TEST_CASE("bodies of any mass bend alike under forces in proportion", "[six]") {
    // ODE's direct solver loses ε A²/8 where it takes a row out, A in 1/(kg m²): below some 1e-8
    // kg m² all of it, and it ends the process. Soft rows reach that earlier.
    const double stiffness = GENERATE(as<double>{}, infinity, 2e4);
    const auto bent = [stiffness](double scale, double nudge = 0) {
        Rig rig("direct", none);
        const V6 capacity = scale * (V6() << 1e5, 1e5, 1e5, 60, 50, 40).finished();
        const V6 springs = V6::Constant(scale * stiffness);
        std::vector<dBodyID> bodies;
        std::vector<ode::PlasticJoint<Six>*> joints;
        for (int i = 0; i < 4; ++i) {
            bodies.push_back(
                rig.body(scale, V3(0.02, 0.09, 0.09) * scale, {i + 0.5, 0, 0}, none, none));
            const Frame frame{{double(i), 0, 0}, along({1, 0, 0})};
            joints.push_back(&rig.six_axis(bodies.back(),
                                           i > 0 ? bodies[std::size_t(i - 1)] : nullptr, frame,
                                           six(capacity, infinity, springs)));
        }
        std::vector<double> result;
        for (int step = 0; step < 500; ++step) { // bent, then damped until it rests
            const double swing = step < 150 ? std::cos(0.1 * step) : 1;
            Rig::apply_force(bodies.back(), scale * V3(0, -30, 25 * swing + nudge));
            Rig::apply_force(bodies[1], scale * V3(0, 40 * swing, 0));
            Rig::apply_torque(bodies[2], scale * V3(20, 0, 0));
            rig.step(1e-2);
        }
        for (const auto* joint : joints) {
            CHECK(joint->outcome() != Outcome::unreliable);
            result.push_back(joint->absorbed_energy() / scale);
            result.push_back(joint->force(JointAxis::bending_x) / scale);
        }
        for (const dBodyID body : bodies) {
            const V3 at = Rig::position(body);
            result.insert(result.end(), at.begin(), at.end());
        }
        CHECK(std::abs(rig.ledger().unexplained()) < 1e-9 * scale);
        return result;
    };
    const std::vector<double> usual = bent(1);
    CHECK(*std::max_element(usual.begin(), usual.end()) > 1);
    const auto off = [&usual](const std::vector<double>& other) {
        double worst = 0;
        for (std::size_t i = 0; i < usual.size(); ++i) {
            worst = std::max(worst, std::abs(other[i] - usual[i]) / (1 + std::abs(usual[i])));
        }
        return worst;
    };
    // what the chain makes of a push in the last digits: ties between its rows are solved to the
    // softness, and an elastic chain enlarges that a hundred times as much as a rigid one
    double enlarged = 0;
    for (const double nudge : {1e-9, -1e-9, 1e-11, -1e-11}) {
        enlarged = std::max(enlarged, off(bent(1, nudge)));
    }
    CHECK(enlarged < 1e-8);
    for (const double scale : {1e-3, 1e-6, 1e-9, 1e3}) {
        INFO("masses times " << scale << ", stiffness " << stiffness);
        CHECK(off(bent(scale)) < 4 * enlarged);
    }
}

TEST_CASE("rows that ODE solves itself bend bodies of any mass alike", "[six]") {
    // beside a hinge of ODE's own, which keeps the island with ODE; where its solver takes a row
    // out that is left as it is, all of the answer goes at A = 1e8 1/(kg m²)
    const auto bent = [](double scale) {
        Rig rig("direct", none);
        const V6 capacity = scale * (V6() << 1e5, 1e5, 1e5, 60, 50, 40).finished();
        const auto arm = rig.body(scale, V3(0.02, 0.09, 0.09) * scale, {0.5, 0, 0}, none, none);
        const auto flap = rig.body(scale, V3(0.09, 0.09, 0.02) * scale, {1, 0.5, 0}, none, none);
        auto& root = rig.six_axis(arm, nullptr, {{0, 0, 0}, along({1, 0, 0})}, six(capacity));
        rig.pin(arm, flap, {1, 0, 0}, {1, 0, 0});
        for (int step = 0; step < 60; ++step) {
            Rig::apply_force(arm, scale * V3(0, 70 * std::cos(0.1 * step), 90));
            Rig::apply_torque(arm, scale * V3(45, 0, 0));
            rig.step(1e-2);
        }
        const V3 at = Rig::position(arm);
        return std::array{root.absorbed_energy() / scale, at.x(), at.y(), at.z()};
    };
    const auto usual = bent(1);
    CHECK(usual[0] > 1);
    for (const double scale : {1e-1, 1e-3, 1e-4, 1e-6}) {
        INFO("masses times " << scale);
        const auto other = bent(scale);
        for (std::size_t i = 0; i < usual.size(); ++i) {
            CHECK(other[i] == Approx(usual[i]).epsilon(2e-9).margin(2e-9));
        }
    }
}

TEST_CASE("a six-axis joint goes on from saved state bit for bit", "[six]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    struct Saved {
        std::array<double, 13> body{};
        ode::PlasticJoint<Six>::State joint;
    };
    V6 stiffness;
    stiffness << 2e4, 3e4, infinity, 400, infinity, 300;
    struct Scene {
        Scene(const std::string& by, const V6& k) : rig(by, {0, 0, -9.81}) {
            body = rig.body(2, sphere(0.3), {0, 0, 0.2}, none, {20, 15, 5});
            joint = &rig.six_axis(body, nullptr, Frame{}, six(capacities(), infinity, k));
        }
        [[nodiscard]] Saved save() const {
            Saved s{.joint = joint->state()};
            double* to = s.body.data();
            to = std::copy_n(dBodyGetPosition(body), 3, to);
            to = std::copy_n(dBodyGetQuaternion(body), 4, to);
            to = std::copy_n(dBodyGetLinearVel(body), 3, to);
            std::copy_n(dBodyGetAngularVel(body), 3, to);
            return s;
        }
        void restore(const Saved& s) const {
            const double* v = s.body.data();
            dBodySetPosition(body, v[0], v[1], v[2]);
            const dQuaternion q{v[3], v[4], v[5], v[6]};
            dBodySetQuaternion(body, q);
            dBodySetLinearVel(body, v[7], v[8], v[9]);
            dBodySetAngularVel(body, v[10], v[11], v[12]);
            joint->restore(s.joint);
            dRandSetSeed(0);
        }
        Rig rig;
        dBodyID body = nullptr;
        ode::PlasticJoint<Six>* joint = nullptr;
    };
    Scene whole(solver, stiffness);
    for (int i = 0; i < 20; ++i) whole.rig.step(1e-3);
    const Saved saved = whole.save();
    // ODE normalises the quaternion that it is given: the first run is given its own as well
    whole.restore(saved);
    for (int i = 0; i < 40; ++i) whole.rig.step(1e-3);
    const Saved end = whole.save();
    Scene resumed(solver, stiffness);
    resumed.restore(saved);
    for (int i = 0; i < 40; ++i) resumed.rig.step(1e-3);
    CHECK(saved.joint.joint.plastic_work > 1);
    CHECK(end.joint.joint.plastic_work > saved.joint.joint.plastic_work);
    CHECK(resumed.save().joint == end.joint);
    CHECK(resumed.save().body == end.body);

    SECTION("a broken joint stays broken, and one from before the break holds again") {
        Scene scene(solver, stiffness);
        ode::PlasticJoint<Six>::State broken = saved.joint;
        broken.joint.broken = true;
        scene.joint->restore(broken);
        CHECK(scene.joint->broken());
        CHECK(dJointIsEnabled(scene.joint->id()) == 0);
        CHECK(scene.joint->outcome() == Outcome::broken);
        scene.restore(saved);
        for (int i = 0; i < 40; ++i) scene.rig.step(1e-3);
        CHECK(scene.save().body == end.body);
    }
}

TEST_CASE("after a break nothing of a six-axis joint is left on its bodies", "[six]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    Rig rig(solver, none);
    auto a = rig.body(2, sphere(0.3), {0, 0, 0.2}, none, {20, 15, 5});
    auto b = rig.body(3, sphere(0.5), {0, 0, -0.4}, none, none);
    auto& joint = rig.six_axis(a, b, Frame{}, six(capacities(), 3.0));
    for (int i = 0; i < 2000 && !joint.broken(); ++i) rig.step(1e-3);
    REQUIRE(joint.broken());
    const V3 v = Rig::velocity(a), w = Rig::spin(a);
    for (int i = 0; i < 100; ++i) rig.step(1e-3);
    CHECK((Rig::velocity(a) - v).norm() == 0);
    CHECK((Rig::spin(a) - w).norm() < 1e-12 * w.norm());
    for (dBodyID body : {a, b}) {
        for (int i = 0; i < dBodyGetNumJoints(body); ++i) {
            CHECK(dJointIsEnabled(dBodyGetJoint(body, i)) == 0);
        }
    }
    for (const JointAxis axis : all_joint_axes) CHECK(joint.force(axis) == 0);
    CHECK(joint.utilisation() == 0);
}

TEST_CASE("rows that a step leaves out leave no force behind", "[six]") {
    Rig rig(Rig::solvers().front(), none);
    const dBodyID body = rig.body(1, sphere(0.5), none, none, none);
    ode::PointRows rows(rig.world());
    const auto pushed = [&](double along_z) {
        std::array<ode::PointRow, 3> of;
        for (int i = 0; i < 3; ++i) {
            of[std::size_t(i)].direction[i] = 1;
            of[std::size_t(i)].row = {.strength = i < 2 ? 5 : along_z, .velocity = 100};
        }
        rows.make(body, nullptr, none, of);
        rig.step(0.01);
        return rows.collect().force;
    };
    const V3 all = pushed(5), two = pushed(0);
    CHECK(std::abs(all[2]) == Approx(5));
    CHECK(std::abs(two[0]) == Approx(5));
    CHECK(two[2] == 0);
}

TEST_CASE("rows are scaled to where ODE's direct solver keeps nine digits", "[six]") {
    // taking one out loses a share of ε A²/8 (point_rows.hpp)
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    for (double diagonal = 1; diagonal < 1e13; diagonal *= 3) {
        const double s = ode::row_scale(diagonal), made = s * s * diagonal;
        CHECK(epsilon * made * made / 8 < 3e-9);
    }
}

TEST_CASE("bodies that sleep on a six-axis joint wake as they fell asleep", "[six]") {
    // loaded in two directions, so that the bounds are not symmetric and a force acts from outside
    const auto solver = GENERATE(from_range(Rig::solvers()));
    Rig rig(solver, {3, 4, -9.81});
    dWorldSetAutoDisableFlag(rig.world(), 1);
    auto body = rig.body(2, sphere(0.3), {0.8, 0, 0}, none, none);
    dBodySetAutoDisableFlag(body, 1);
    auto& joint = rig.six_axis(body, nullptr, Frame{}, six(V6::Constant(100)));
    for (int i = 0; i < 200; ++i) rig.step(1.0 / 60);
    REQUIRE(dBodyIsEnabled(body) == 0);
    const V3 at = Rig::position(body);
    const double held = joint.force(JointAxis::axial);
    CHECK(held == Approx(2 * 9.81).epsilon(1e-3));
    for (int i = 0; i < 100; ++i) rig.step(1.0 / 60);
    CHECK(ode::to_core(dBodyGetForce(body)).norm() == 0);
    CHECK(ode::to_core(dBodyGetTorque(body)).norm() == 0);
    dBodyEnable(body);
    rig.step(1.0 / 60);
    CHECK((Rig::position(body) - at).norm() < 1e-6);
    CHECK(joint.force(JointAxis::axial) == Approx(held).epsilon(1e-3));
    CHECK(joint.absorbed_energy() == 0);
}

TEST_CASE("hands that move the bodies of a six-axis joint bend nothing", "[six]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    const double stiffness = GENERATE(as<double>{}, infinity, 2e3);
    INFO(solver << ", k = " << stiffness);
    struct Braked {
        Rig rig;
        dBodyID rotor;
        ode::PlasticJoint<Six>& joint;
        Braked(const std::string& solver, double k)
            : rig(solver, none),
              rotor(rig.body(1, sphere(2), none, none, {0, 0, 10})),
              joint(rig.six_axis(rotor, nullptr, Frame{},
                                 six(V6::Constant(40), infinity, V6::Constant(k)))) {}
    };
    Braked moved(solver, stiffness), twin(solver, stiffness);
    const double dt = 1.0 / 240;
    double hands = 0;
    for (int i = 0; i < 300; ++i) {
        if (i == 60 || i == 200) { // while it flows, and when it has stopped or swings
            const Eigen::Quaterniond by(Eigen::AngleAxisd(0.7, V3::UnitZ()));
            const dReal* q = dBodyGetQuaternion(moved.rotor);
            const Eigen::Quaterniond to = by * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
            const dReal values[4] = {to.w(), to.x(), to.y(), to.z()};
            dBodySetQuaternion(moved.rotor, values);
            const dReal* p = dBodyGetPosition(moved.rotor);
            dBodySetPosition(moved.rotor, p[0], p[1], p[2] + dReal(0.1));
            hands += 0.7;
        }
        moved.rig.step(dt);
        twin.rig.step(dt);
    }
    CHECK(twin.joint.absorbed_energy() == Approx(100).epsilon(0.02)); // 2 kg m² at 10 rad/s
    CHECK(moved.joint.absorbed_energy() == Approx(twin.joint.absorbed_energy()).epsilon(exact));
    CHECK(moved.joint.stored_energy() ==
          Approx(twin.joint.stored_energy()).epsilon(exact).margin(exact));
    const double turned_by_hand = moved.joint.plastic_offset(JointAxis::torsion) -
                                  twin.joint.plastic_offset(JointAxis::torsion);
    CHECK(turned_by_hand == Approx(hands).epsilon(exact));
}

TEST_CASE("a six-axis joint does nothing while disabled or without a body", "[six]") {
    const auto solver = GENERATE(from_range(Rig::solvers()));
    Rig rig(solver, {0, 0, -9.81});
    auto a = rig.body(2, sphere(0.3), {0.8, 0, 0}, none, none);
    auto b = rig.body(2, sphere(0.3), {-0.8, 0, 0}, none, none);
    auto& joint = rig.six_axis(a, b, Frame{}, six(V6::Constant(1000)));
    rig.step(1e-3);
    dJointDisable(joint.id());
    Rig::set_velocity(a, {0, 0, 1});
    rig.step(1e-3);
    CHECK(Rig::velocity(a).z() == Approx(1 - 9.81e-3).epsilon(exact));
    CHECK(joint.force(JointAxis::axial) == 0);
    dJointEnable(joint.id());
    rig.step(1e-3);
    CHECK(Rig::velocity(a).z() < 0.9);
    CHECK_FALSE(joint.detached());
    rig.destroy(b);
    CHECK(joint.detached());
    const double before = Rig::velocity(a).z();
    rig.step(1e-3);
    CHECK(Rig::velocity(a).z() == Approx(before - 9.81e-3).epsilon(exact));
    CHECK(joint.absorbed_energy() >= 0);
}

TEST_CASE("a six-axis joint refuses what makes no joint", "[six]") {
    Rig rig("direct", none);
    auto a = rig.body(1, sphere(1), none, none, none);
    const auto message = [&](dBodyID first, dBodyID second, const Frame& frame) {
        return message_of(
            [&] { ode::PlasticJoint(rig.world(), first, second, frame, six(capacities())); });
    };
    CHECK(message(nullptr, a, {}) ==
          "PlasticJoint.a = null: must be a body (only b may be the static world)");
    CHECK(message(a, a, {}) == "PlasticJoint.b: must not be body a itself");
    CHECK(message(a, nullptr, {.origin = {0, std::nan(""), 0}}) ==
          "PlasticJoint.in_world.origin: must be finite [m]");
    const M3 skew = M3::Identity() + 0.1 * M3::Ones(), left = -M3::Identity();
    for (const M3& axes : {skew, left}) {
        CHECK(message(a, nullptr, {.axes = axes}) ==
              "PlasticJoint.in_world.axes: must be three orthonormal columns, right-handed");
    }
    CHECK(message_of([&] {
              ode::PlasticJoint(rig.world(), a, nullptr, Frame{}, Frame{.axes = skew},
                                six(capacities()));
          }) == "PlasticJoint.in_b.axes: must be three orthonormal columns, right-handed");
    CHECK(dBodyGetNumJoints(a) == 0);
}
