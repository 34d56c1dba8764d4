// SPDX-License-Identifier: MIT
//
// What a joint reports of its first yield and of its break, against closed forms, on bodies that
// only the joint and a given load act on: the rows are solved exactly by clamping.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "ductile/fracture/any_of.hpp"
#include "ductile/fracture/brittle_force.hpp"
#include "ductile/fracture/energy_limit.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/law/softening.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "support/property.hpp"

using namespace ductile;

namespace {

template <class Joint>
struct Mass {
    using S = typename Joint::Scalar;

    Mass(Joint j, S m) : joint(std::move(j)), mass(m) {}

    Step<S> step(S dt, S load = 0) {
        const RowLimits<S> row = joint.prepare({position, velocity, mass}, dt);
        const S free = velocity + dt * load / mass;
        const S wanted = (row.bias - free) / (1 / mass + row.compliance);
        const S impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
        velocity = free + impulse / mass;
        position += velocity * dt;
        return joint.commit({impulse / dt, velocity, position}, dt);
    }
    FractureEvent<S> run_to_break(S dt, S load = 0) {
        for (int i = 0; i < 10000000 && !joint.state().broken; ++i) step(dt, load);
        REQUIRE(joint.fracture());
        return *joint.fracture();
    }

    Joint joint;
    S mass;
    S position = 0;
    S velocity = 0;
};

const Perfect<double> forty({.strength = 40});

/// Error of the break's time at `dt` and over three halvings of it.
template <class Error>
void check_second_order(double dt, Error error) {
    // one step in which the break falls early or late changes the factor: judged over all halvings
    const double coarse = error(dt), fine = error(dt / 8);
    INFO("error " << coarse << " s at " << dt << " s, " << fine << " s at an eighth");
    CHECK(std::log2(coarse / fine) / 3 >= 1.8);
}

} // namespace

TEST_CASE("a break reports its time to round-off at any step", "[fracture_event]") {
    // 2 kg m², 40 N m, 10 rad/s: ω falls by 20 rad/s per second
    test::prop("any limit and step", [] {
        const double dt = *rc::gen::inRange(1, 1000) / 1e4;
        const double limit = *rc::gen::inRange(1, 2400) / 1e3;
        const double way = *rc::gen::element(1.0, -1.0);
        Mass rotor(OneAxisJoint(forty, TravelLimit<double>({.limit = limit})), 2.0);
        rotor.velocity = 10 * way;
        const FractureEvent<double> event = rotor.run_to_break(dt);
        RC_ASSERT(std::abs(event.time - (10 - std::sqrt(100 - 40 * limit)) / 20) < 1e-11);
        RC_ASSERT(event.axis == 0u);
        RC_ASSERT(event.criterion == CriterionKind::plastic_travel);
        RC_ASSERT(event.plastic_travel == Approx(limit).epsilon(1e-12));
        RC_ASSERT(event.absorbed_energy == Approx(40 * limit).epsilon(1e-12));
        RC_ASSERT(event.released_energy == 0);
        RC_ASSERT(event.force == Approx(-40 * way).epsilon(1e-12));
    });
}

TEST_CASE("under a load and with hardening the break's time is second order", "[fracture_event]") {
    const TravelLimit<double> limit({.limit = 1.3});
    SECTION("a load of 10 N m with the motion: 15 rad/s per second") {
        const double exact = (10 - std::sqrt(100 - 2 * 15 * 1.3)) / 15;
        check_second_order(0.02, [&](double dt) {
            Mass rotor(OneAxisJoint(forty, limit), 2.0);
            rotor.velocity = 10;
            return std::abs(rotor.run_to_break(dt, 10).time - exact);
        });
    }
    SECTION("M = 40 + 30 θ: θ = A sin(ωt) - B (1 - cos ωt), ω² = 15, A = 10/ω, B = 4/3") {
        const double w = std::sqrt(15.0), a = 10 / w, b = 4.0 / 3;
        // A sin + B cos = r cos(ωt - φ)
        const double exact = (std::atan2(a, b) - std::acos((1.3 + b) / std::hypot(a, b))) / w;
        const auto run = [&](double dt) {
            Mass rotor(OneAxisJoint(Linear<double>({.strength = 40, .hardening = 30}), limit), 2.0);
            rotor.velocity = 10;
            return rotor.run_to_break(dt);
        };
        check_second_order(0.02, [&](double dt) { return std::abs(run(dt).time - exact); });
        CHECK(run(0.02).force ==
              Approx(-(40 + 30 * 1.3)).epsilon(1e-12)); // at the break, not the mean
        CHECK(run(0.02).absorbed_energy == Approx(40 * 1.3 + 15 * 1.3 * 1.3).epsilon(1e-12));
    }
}

TEST_CASE("an elastic-plastic break reports the stored energy it set free", "[fracture_event]") {
    // k = 4000 N m/rad, ω = √(k/I): yields at 0.01 rad, asin(ω 0.01/10)/ω; then 20 rad/s per second
    const double w = std::sqrt(2000.0), until_yield = std::asin(w * 0.01 / 10) / w;
    const double speed = 10 * std::cos(w * until_yield);
    const double exact = until_yield + (speed - std::sqrt(speed * speed - 40 * 0.5)) / 20;
    const auto run = [&](double dt) {
        Mass rotor(OneAxisJoint(forty, TravelLimit<double>({.limit = 0.5}), {.stiffness = 4000.0}),
                   2.0);
        rotor.velocity = 10;
        return rotor.run_to_break(dt);
    };
    for (const double dt : {1e-2, 1e-3, 1e-4}) { // in between, resolved, well resolved
        const FractureEvent<double> event = run(dt);
        INFO("dt = " << dt);
        // the engine moves with the new velocity, which leaves yield within a step of its place
        CHECK(std::abs(event.time - exact) < dt);
        CHECK(event.released_energy == Approx(40.0 * 40 / 2 / 4000).epsilon(1e-9));
        CHECK(event.absorbed_energy == Approx(20).epsilon(1e-12));
        CHECK(event.force == Approx(-40));
    }
}

TEST_CASE("a brittle break reports its cap and when it was met", "[fracture_event]") {
    const BrittleForce<double> cap({.limit = 15});
    const Perfect<double> law({.strength = 20});
    SECTION("rigid: at the start of the step that brought the load") {
        Mass body(OneAxisJoint(law, cap), 2.0);
        for (int i = 0; i < 10; ++i) body.step(0.01, 14.9);
        CHECK_FALSE(body.joint.fracture());
        CHECK(body.step(0.01, -15.1).fracture);
        const FractureEvent<double> event = *body.joint.fracture();
        CHECK(event.criterion == CriterionKind::brittle_force);
        CHECK(event.time == Approx(0.1).epsilon(1e-12));
        CHECK(event.force == Approx(15).epsilon(1e-12)); // it held against a pull the other way
        CHECK(event.absorbed_energy == 0);
        CHECK(event.plastic_travel == 0);
    }
    SECTION("elastic: when the spring has been stretched so far") {
        const double w = std::sqrt(250.0), exact = std::asin(w * 15 / 500 / 3) / w;
        for (const double dt : {1e-2, 1e-3, 1e-4}) {
            Mass body(OneAxisJoint(law, cap, {.stiffness = 500.0}), 2.0);
            body.velocity = 3;
            const FractureEvent<double> event = body.run_to_break(dt);
            INFO("dt = " << dt);
            CHECK(std::abs(event.time - exact) < dt);
            CHECK(event.released_energy == Approx(15.0 * 15 / 1000).epsilon(1e-9));
            CHECK(event.force == Approx(-15).epsilon(1e-12));
        }
    }
}

TEST_CASE("a break names what broke it", "[fracture_event]") {
    SECTION("the first of several") {
        const AnyOf any(TravelLimit<double>({.limit = 2}), EnergyLimit<double>({.limit = 12}));
        Mass body(OneAxisJoint(forty, any), 2.0);
        body.velocity = 10;
        CHECK(body.run_to_break(0.01).criterion == CriterionKind::absorbed_energy);
    }
    SECTION("the law itself where that has softened to nothing") {
        const Softening<double> law({.strength = 40, .plateau = 0.2, .exhaustion = 0.6});
        Mass body(OneAxisJoint(law, TravelLimit<double>({.limit = 9})), 2.0);
        body.velocity = 10;
        const FractureEvent<double> event = body.run_to_break(0.001);
        CHECK(event.criterion == CriterionKind::exhausted_strength);
        CHECK(event.name() == "exhausted strength");
        CHECK(event.force == Approx(0).margin(1e-9));
        CHECK(event.absorbed_energy == Approx(40 * 0.2 + 40 * 0.4 / 2).epsilon(1e-9));
    }
}

TEST_CASE("the step of the first yield says so, once in a joint's life", "[fracture_event]") {
    OneAxisJoint joint(forty, TravelLimit<double>({.limit = 0.5}));
    Mass body(joint, 2.0);
    for (int i = 0; i < 50; ++i) CHECK_FALSE(body.step(0.01, 39.9).first_yield);
    int first = 0, breaks = 0;
    for (int swing = 0; swing < 20; ++swing) { // yields, rests, yields the other way, breaks
        for (int i = 0; i < 10; ++i) {
            const Step<double> step = body.step(0.01, swing % 2 == 0 ? 60.0 : -60.0);
            if (step.first_yield) {
                CHECK(swing == 0);
                CHECK(i == 0);
                CHECK(step.outcome == Outcome::yielding);
            }
            first += step.first_yield;
            breaks += step.fracture;
            if (step.fracture) CHECK(step.outcome == Outcome::broken);
            if (breaks == 0) CHECK_FALSE(body.joint.fracture());
        }
    }
    CHECK(first == 1);
    CHECK(breaks == 1);
}

TEST_CASE("one step may both yield for the first time and break", "[fracture_event]") {
    Mass body(OneAxisJoint(forty, TravelLimit<double>({.limit = 0.01})), 2.0);
    body.velocity = 10;
    const Step<double> step = body.step(0.1);
    CHECK(step.first_yield);
    CHECK(step.fracture);
    const Step<double> after = body.step(0.1);
    CHECK_FALSE(after.first_yield);
    CHECK_FALSE(after.fracture);
    CHECK(after.outcome == Outcome::broken);
}

TEST_CASE("a restored joint keeps its clock, its first yield and its break", "[fracture_event]") {
    OneAxisJoint fresh(forty, TravelLimit<double>({.limit = 1}));
    Mass a(fresh, 2.0);
    a.velocity = 10;
    for (int i = 0; i < 5; ++i) a.step(0.01);
    Mass b(fresh, 2.0);
    b.joint.restore(a.joint.state());
    b.position = a.position;
    b.velocity = a.velocity;
    CHECK_FALSE(b.step(0.01).first_yield);
    a.step(0.01);
    CHECK(a.run_to_break(0.01) == b.run_to_break(0.01));
    fresh.restore(a.joint.state());
    CHECK(fresh.fracture() == a.joint.fracture());
    static_assert(std::is_trivially_copyable_v<decltype(fresh)::State>);
}

TEST_CASE("a joint in single precision counts its time for years", "[fracture_event]") {
    OneAxisJoint joint(Perfect<float>({.strength = 40}), TravelLimit<float>({.limit = 1}));
    auto state = joint.state();
    state.time = 1e8;
    joint.restore(state);
    for (int i = 0; i < 1000; ++i) {
        (void)joint.prepare({}, 0.001f);
        joint.commit({}, 0.001f);
    }
    CHECK(joint.state().time - 1e8 == Approx(1).epsilon(1e-5)); // 1000 sums at 1.5e-8 each
}

// ---- coupled
// ----------------------------------------------------------------------------------------

namespace {

using V2 = Eigen::Vector2d;
using Ellipse = Ellipsoid<double, 2>;

template <class Joint>
struct Plate {
    Plate(Joint j, const V2& m) : joint(std::move(j)), mass(m) {}

    typename Joint::Step step(double dt, const V2& load = V2::Zero()) {
        const auto rows = joint.prepare({position, velocity, mass.asDiagonal()}, dt);
        V2 force;
        for (int i = 0; i < 2; ++i) {
            const auto& row = rows[std::size_t(i)];
            const double free = velocity[i] + dt * load[i] / mass[i];
            const double wanted = (row.bias - free) / (1 / mass[i] + row.compliance);
            const double impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
            velocity[i] = free + impulse / mass[i];
            force[i] = impulse / dt;
        }
        position += velocity * dt;
        return joint.commit({force, velocity, position}, dt);
    }
    FractureEvent<double> run_to_break(double dt) {
        for (int i = 0; i < 1'000'000 && !joint.state().broken; ++i) step(dt);
        REQUIRE(joint.fracture());
        return *joint.fracture();
    }

    Joint joint;
    V2 mass;
    V2 position = V2::Zero();
    V2 velocity = V2::Zero();
};

} // namespace

TEST_CASE("a coupled break reports its time along its own direction to round-off",
          "[fracture_event]") {
    // isotropic: 40 N m along 30 degrees, 2 kg m², 10 rad/s
    const V2 along(std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6));
    for (const double dt : {1.0 / 60, 1.0 / 240, 1e-3}) {
        Plate plate(CoupledJoint(Ellipse({.capacity = V2(40, 40)}), forty,
                                 TravelLimit<double>({.limit = 1.3})),
                    V2(2, 2));
        plate.velocity = 10 * along;
        const FractureEvent<double> event = plate.run_to_break(dt);
        INFO("dt = " << dt);
        CHECK(event.time == Approx((10 - std::sqrt(48.0)) / 20).epsilon(1e-9));
        CHECK(event.axis == 0);
        CHECK(event.criterion == CriterionKind::plastic_travel);
        CHECK(event.plastic_travel == Approx(1.3).epsilon(1e-12));
        CHECK(event.absorbed_energy == Approx(52).epsilon(1e-12));
        CHECK(event.force == Approx(-40 * along[0]).epsilon(1e-6)); // and not the lowered bound
    }
}

TEST_CASE("a coupled break is on the axis that did most of the work", "[fracture_event]") {
    for (const int most : {0, 1}) {
        V2 velocity(2, 2);
        velocity[most] = 9;
        Plate plate(CoupledJoint(Ellipse({.capacity = V2(40, 30)}), forty,
                                 TravelLimit<double>({.limit = 0.5}), {.stiffness = V2(4e5, 4e5)}),
                    V2(2, 2));
        plate.velocity = velocity;
        const FractureEvent<double> event = plate.run_to_break(1e-4);
        CHECK(event.axis == std::size_t(most));
        CHECK(event.released_energy > 0);
        CHECK(event.released_energy == plate.joint.state().lost);
        CHECK(event.force < 0);
    }
}

TEST_CASE("a coupled joint says its first yield and its break, each once", "[fracture_event]") {
    Plate plate(
        CoupledJoint(Ellipse({.capacity = V2(40, 30)}), forty, TravelLimit<double>({.limit = 0.5})),
        V2(2, 2));
    int first = 0, breaks = 0;
    for (int i = 0; i < 400; ++i) {
        const double grown = i / 100.0; // yields at 1 along (1, 1)
        const auto step = plate.step(0.01, grown * 24.1 * V2(1, 1));
        if (step.first_yield) CHECK(grown == Approx(1).margin(0.02));
        first += step.first_yield;
        breaks += step.fracture;
        if (breaks == 0) CHECK_FALSE(plate.joint.fracture());
    }
    CHECK(first == 1);
    CHECK(breaks == 1);
}

TEST_CASE("a brittle coupled joint breaks where the equivalent force meets its cap",
          "[fracture_event]") {
    // cap 20 of 40: on the half ellipse; axis 1 carries more of the gauge
    const BrittleForce<double> cap({.limit = 20});
    const V2 capacity(40, 30), at(0.6, 0.8);
    const V2 load = capacity.cwiseProduct(at) / 2;
    SECTION("rigid: a load below it is held, one above goes through") {
        Plate plate(CoupledJoint(Ellipse({.capacity = capacity}), forty, cap), V2(2, 2));
        for (int i = 0; i < 100; ++i) plate.step(0.01, 0.99 * load);
        CHECK_FALSE(plate.joint.state().broken);
        CHECK(plate.position.norm() < 1e-12);
        const auto step = plate.step(0.01, 1.05 * load);
        CHECK(step.fracture);
        CHECK(step.plastic_work == 0);
        const FractureEvent<double> event = *plate.joint.fracture();
        CHECK(event.criterion == CriterionKind::brittle_force);
        CHECK(event.axis == 1);
        // one row is held at the chord of the last step, so the force has turned a little
        CHECK(event.force == Approx(-load[1]).epsilon(0.01));
        CHECK(plate.joint.surface().value(plate.joint.state().force) == Approx(0.5).epsilon(1e-9));
        CHECK(event.absorbed_energy == 0);
        CHECK(event.time == Approx(1).epsilon(1e-12));
    }
    SECTION("elastic: what was stored is lost, nothing absorbed") {
        Plate plate(CoupledJoint(Ellipse({.capacity = capacity}), forty, cap,
                                 {.stiffness = V2(4000, 4000)}),
                    V2(2, 2));
        plate.velocity = V2(0, 1);
        const FractureEvent<double> event = plate.run_to_break(1e-5);
        CHECK(event.axis == 1);
        CHECK(event.criterion == CriterionKind::brittle_force);
        CHECK(event.force == Approx(-15).epsilon(1e-6));
        CHECK(event.released_energy == Approx(15.0 * 15 / 8000).epsilon(1e-4));
        const double w = std::sqrt(2000.0);
        CHECK(event.time == Approx(std::asin(w * 15 / 4000) / w).margin(1e-5));
    }
}
