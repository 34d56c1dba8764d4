// SPDX-License-Identifier: MIT
//
// The coupled joint on a body whose axes are decoupled (diagonal mass), so that clamping solves the
// rows exactly and every difference from the closed form is the joint's own.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/numeric/lu.hpp"
#include "ductile/solve/ellipsoid_return.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/surface/rectangle_axial_bending.hpp"
#include "ductile/surface/scaled.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

template <class Joint>
struct Body {
    using S = typename Joint::Scalar;
    using Vector = typename Joint::Vector;

    Body(Joint j, const Vector& m) : joint(std::move(j)), mass(m) {}

    typename Joint::Step step(S dt, const Vector& load = Vector::Zero()) {
        const auto rows = joint.prepare({position, velocity, mass.asDiagonal()}, dt);
        Vector force, after;
        for (int i = 0; i < Joint::dimension; ++i) {
            const auto& row = rows[std::size_t(i)];
            const S free = velocity[i] + dt * load[i] / mass[i];
            const S wanted = (row.bias - free) / (1 / mass[i] + row.compliance);
            const S impulse = std::clamp(wanted, row.lower * dt, row.upper * dt);
            after[i] = free + impulse / mass[i];
            force[i] = impulse / dt;
        }
        position += after * dt;
        taken += -dt * force.dot(velocity + after) / 2;
        const auto step = joint.commit({force, after, position}, dt);
        velocity = after;
        return step;
    }
    [[nodiscard]] S kinetic() const { return mass.cwiseProduct(velocity.cwiseAbs2()).sum() / 2; }

    Joint joint;
    Vector mass;
    Vector position = Vector::Zero();
    Vector velocity = Vector::Zero();
    S taken = 0;
};

using Ellipse = Ellipsoid<double, 2>;
using V2 = Eigen::Vector2d;

auto ellipse_joint(double bending, double torsion, double limit) {
    return CoupledJoint(Ellipse({.capacity = V2(bending, torsion)}),
                        Perfect<double>({.strength = bending}),
                        TravelLimit<double>({.limit = limit}));
}
constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("one coupled axis is the one-axis joint", "[coupled_joint]") {
    CoupledJoint coupled(Ellipsoid<double, 1>({.capacity = Eigen::Matrix<double, 1, 1>(40.0)}),
                         Perfect<double>({.strength = 40}), TravelLimit<double>({.limit = 2.2}));
    OneAxisJoint single(Perfect<double>({.strength = 40}), TravelLimit<double>({.limit = 2.2}));
    Body<decltype(coupled)> body(coupled, Eigen::Matrix<double, 1, 1>(2.0));
    body.velocity[0] = 10;
    double q = 0, u = 10;
    const double dt = 0.0123;
    for (int i = 0; i < 60 && !single.state().broken; ++i) {
        body.step(dt);
        const auto row = single.prepare({q, u}, dt);
        const double impulse = std::clamp(2 * (row.bias - u), row.lower * dt, row.upper * dt);
        u += impulse / 2;
        q += u * dt;
        single.commit({impulse / dt, u, q}, dt);
        REQUIRE(body.joint.state().plastic_work ==
                Approx(single.state().plastic_work).epsilon(1e-9));
        REQUIRE(body.joint.state().broken == single.state().broken);
    }
    CHECK(single.state().broken);
}

TEST_CASE("energy is exact in any direction of an ellipse", "[coupled_joint]") {
    test::prop("any masses, capacities, speeds and steps", [] {
        const auto number = [](int hi) { return *rc::gen::inRange(1, hi) / 10.0; };
        const V2 capacity(number(900), number(900)), mass(number(50), number(50));
        Body body(ellipse_joint(capacity[0], capacity[1], infinity), mass);
        body.velocity = V2(number(100) - 5, number(100) - 5);
        const double energy = body.kinetic();
        RC_PRE(energy > 0);
        const double dt = *rc::gen::inRange(1, 50) * 1e-3;
        for (int i = 0; i < 100000 && body.kinetic() > 1e-20 * energy; ++i) body.step(dt);
        const auto& state = body.joint.state();
        RC_ASSERT(std::abs(body.taken - energy) < 1e-9 * energy);
        RC_ASSERT(std::abs(state.plastic_work + state.other_work - energy) < 1e-9 * energy);
        // the surface is enforced through boxes: all but a little is flow
        RC_ASSERT(std::abs(state.other_work) < 0.02 * energy);
    });
}

TEST_CASE("an isotropic joint stops along its own direction", "[coupled_joint]") {
    // capacity 40 N m any way, 2 kg m², 10 rad/s at 30 degrees: 2.5 rad along 30 degrees, less u
    // dt/2
    Body body(ellipse_joint(40, 40, infinity), V2(2, 2));
    const V2 along(std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6));
    body.velocity = 10 * along;
    const double dt = 1.0 / 1000;
    for (int i = 0; i < 600; ++i) body.step(dt);
    CHECK(body.position.normalized().dot(along) == Approx(1).epsilon(1e-6));
    CHECK(body.position.norm() == Approx(2.5).margin(1.5 * 10 * dt / 2));
    CHECK(body.joint.state().plastic_work == Approx(100).epsilon(1e-3));
}

TEST_CASE("a hinge that yields under axial force also extends", "[coupled_joint]") {
    // rectangle h = 0.1 m, N_p = 1 MN, M_p = N_p h/4 = 25 kN m, axial load n = 0.4 held: it bends
    // at m = 1 - n² and its neutral axis is n h/2 off the centroid, so it stretches by that per
    // radian
    const double axial = 1e6, plastic = 25e3, n = 0.4, h = 0.1;
    const Scaled surface(RectangleAxialBending<double>(), {.capacity = V2(axial, plastic)});
    Body body(CoupledJoint(surface, Perfect<double>({.strength = plastic})), V2(1000, 20));
    const double moment = 1.02 * plastic * (1 - n * n);
    for (int i = 0; i < 4000; ++i)
        body.step(1e-4, V2(n * axial, std::min(1.0, i / 500.0) * moment));
    CHECK(body.position[1] > 0.05);
    CHECK(body.position[0] / body.position[1] == Approx(n * h / 2).epsilon(0.03));
    CHECK(body.joint.utilisation() == Approx(1).epsilon(0.01));
}

TEST_CASE("below the surface nothing flows and nothing is consumed", "[coupled_joint]") {
    Body body(ellipse_joint(100, 80, 1), V2(2, 3));
    for (int i = 0; i < 2000; ++i) {
        const double t = i * 0.01;
        body.step(0.01, V2(0.69 * 100 * std::cos(t), 0.69 * 80 * std::sin(3 * t)));
    }
    CHECK(body.joint.state().plastic_work == 0);
    CHECK(body.joint.state().plastic_travel == 0);
    CHECK(body.position.norm() < 1e-12);
}

TEST_CASE("the rows of a coupled joint are the chords through the predicted force",
          "[coupled_joint]") {
    // the definition, spelled out with an inverse for every matrix, against what the joint spares
    const Ellipse surface({.capacity = V2(40, 30)});
    const double dt = 0.01;
    int held = 0, flowed = 0;
    for (const V2& stiffness : {V2(infinity, infinity), V2(infinity, 3000), V2(4000, 3000)}) {
        Body body(CoupledJoint(surface, Perfect<double>({.strength = 40}), TravelLimit<double>(),
                               {.stiffness = stiffness}),
                  V2(2, 1));
        for (int i = 0; i < 300; ++i) {
            const V2 load(36 * std::sin(i * 0.05), 27 * std::cos(i * 0.031));
            const auto before = body.joint.state();
            const V2 velocity = body.velocity;
            auto joint = body.joint;
            const auto rows = joint.prepare({body.position, velocity, body.mass.asDiagonal()}, dt);
            Eigen::Matrix2d compliance = body.mass.cwiseInverse().asDiagonal();
            for (int k = 0; k < 2; ++k) compliance(k, k) += 1 / (stiffness[k] * dt * dt);
            V2 from = before.force; // a spring predicts from its strain
            for (int k = 0; k < 2; ++k) {
                if (!std::isfinite(stiffness[k])) continue;
                from[k] = -stiffness[k] * (body.position[k] - before.plastic_offset[k]);
            }
            const V2 predicted =
                predicted_force(surface, from, velocity, before.start_velocity,
                                Eigen::Matrix2d(numeric::inverse(compliance) / dt));
            const auto box = box_along(surface, predicted);
            for (int k = 0; k < 2; ++k) {
                const auto& row = rows[std::size_t(k)];
                if (row.lower == row.upper) continue; // the force of a resolved spring is given
                REQUIRE(row.lower == Approx(box.lower[k]).epsilon(1e-12).margin(1e-6));
                REQUIRE(row.upper == Approx(box.upper[k]).epsilon(1e-12).margin(1e-6));
            }
            (surface.value(predicted) < 1 - 1e-6 ? held : flowed) += 1;
            body.step(dt, load);
        }
    }
    CHECK(held > 100);
    CHECK(flowed > 100);
}

TEST_CASE("a load that nobody could predict is bounded by the true surface", "[coupled_joint]") {
    // far below yield for long, then one axis is struck: it flows at what the surface leaves it
    // beside the force of the other one, at once and not before
    for (const double share : {0.05, 0.3, 0.6}) {
        const double left = 30 * std::sqrt(1 - share * share);
        for (const double strike : {0.999, 1.001, 20.0}) {
            Body body(ellipse_joint(40, 30, infinity), V2(2, 1));
            for (int i = 0; i < 200; ++i) body.step(0.01, V2(share * 40, 0));
            body.step(0.01, V2(share * 40, strike * left));
            CAPTURE(share, strike);
            CHECK(std::abs(body.joint.state().force[1]) ==
                  Approx(std::min(strike, 1.0) * left).epsilon(1e-9));
            CHECK(body.joint.utilisation() <= 1 + 1e-9);
            CHECK((body.joint.state().plastic_work > 0) == (strike > 1));
        }
    }
}

TEST_CASE("a coupled break takes the energy of its life at every step", "[coupled_joint]") {
    for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
        Body body(ellipse_joint(40, 30, 1.1), V2(2, 2));
        body.velocity = V2(8, 6);
        const double energy = body.kinetic();
        double release = 0;
        for (int i = 0; i < 1000 && !body.joint.state().broken; ++i)
            release += body.step(dt).release;
        INFO("dt = " << dt);
        CHECK(body.joint.state().broken);
        CHECK(body.joint.state().plastic_work == Approx(44).epsilon(1e-9));
        const double balance = energy - body.kinetic() - release - body.joint.state().other_work;
        CHECK(balance == Approx(44).epsilon(1e-9));
    }
}

TEST_CASE("hardening lets the surface grow", "[coupled_joint]") {
    // the same stop on a linear law needs less travel: R₀ p + H p²/2 = E
    const Ellipse surface({.capacity = V2(40, 40)});
    Body body(CoupledJoint(surface, Linear<double>({.strength = 40, .hardening = 30})), V2(2, 2));
    body.velocity = V2(8, 6);
    for (int i = 0; i < 3000; ++i) body.step(1e-3);
    const double travel = (-40 + std::sqrt(1600 + 2 * 30 * 100)) / 30;
    CHECK(body.joint.state().plastic_travel == Approx(travel).epsilon(0.005));
    CHECK(body.joint.state().plastic_work == Approx(100).epsilon(0.005));
}

TEST_CASE("elastic rows of a coupled joint keep the account closed", "[coupled_joint]") {
    for (const double dt : {1e-3, 1e-2, 0.1}) { // resolved, in between, not resolvable
        const Ellipse surface({.capacity = V2(40, 30)});
        Body body(CoupledJoint(surface, Perfect<double>({.strength = 40}), TravelLimit<double>(),
                               {.stiffness = V2(4000, 3000)}),
                  V2(2, 1));
        body.velocity = V2(3, -2);
        for (int i = 0; i < 400; ++i) {
            body.step(dt, V2(30 * std::sin(i * 0.1), 25 * std::cos(i * 0.07)));
            REQUIRE(body.velocity.allFinite());
        }
        const auto& state = body.joint.state();
        INFO("dt = " << dt);
        CHECK(body.taken ==
              Approx(state.plastic_work + state.stored + state.other_work).epsilon(1e-9));
        CHECK(state.plastic_work > 0);
        CHECK(state.stored >= 0);
    }
}

TEST_CASE("bent to yield and then twisted, elastic rows follow the ellipse",
          "[coupled_joint][P23]") {
    // t = tanh δ, m = sech δ after a twist of δ yield strains (Krieg & Krieg 1977); a body so
    // heavy that it goes on as it is told, and rows that the step resolves
    const double delta = GENERATE(0.5, 1.0, 2.0);
    const Eigen::Vector2d capacity(1000, 800), stiffness(50e3, 32e3);
    using Elliptic = CoupledJoint<Ellipse, Perfect<double>>;
    Body<Elliptic> body(Elliptic(Ellipse({.capacity = capacity}), Perfect<double>({.strength = 1}),
                                 TravelLimit<double>(), {.stiffness = stiffness}),
                        Eigen::Vector2d::Constant(1e9));
    const int steps = 400;
    const double dt = 1e-3;
    const Eigen::Vector2d yield = capacity.cwiseQuotient(stiffness);
    Eigen::Vector2d position = Eigen::Vector2d::Zero(), force = position;
    for (int i = 0; i < 2 * steps; ++i) {
        const Eigen::Vector2d velocity =
            i < steps ? Eigen::Vector2d(yield[0], 0) : Eigen::Vector2d(0, delta * yield[1]);
        const Eigen::Vector2d u = velocity / (steps * dt);
        const auto rows = body.joint.prepare({position, u, body.mass.asDiagonal()}, dt);
        for (int k = 0; k < 2; ++k) {
            const auto& row = rows[std::size_t(k)];
            REQUIRE(row.lower == row.upper);
            force[k] = row.lower; // given: lower is upper
        }
        position += u * dt;
        body.joint.commit({force, u, position}, dt);
    }
    INFO("delta " << delta);
    CHECK(-force[0] / capacity[0] == Approx(1 / std::cosh(delta)).margin(2 * delta / steps));
    CHECK(-force[1] / capacity[1] == Approx(std::tanh(delta)).margin(2 * delta / steps));
    CHECK(body.joint.utilisation() == Approx(1).epsilon(delta / steps));
}

TEST_CASE("half a step ahead, elastic rows follow the ellipse too", "[coupled_joint][P23]") {
    // as above in parts of a frame, 30 for the twist, the joint then held: second order
    const double delta = GENERATE(0.5, 1.0, 2.0);
    const Eigen::Vector2d capacity(1000, 800), stiffness(50e3, 32e3);
    using Elliptic = CoupledJoint<Ellipse, Perfect<double>>;
    Elliptic joint(Ellipse({.capacity = capacity}), Perfect<double>({.strength = 1}),
                   TravelLimit<double>(), {.stiffness = stiffness});
    const int steps = 30;
    const double dt = 1.0 / 60;
    const Eigen::Matrix2d mass = 1e9 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d yield = capacity.cwiseQuotient(stiffness);
    Eigen::Vector2d position = Eigen::Vector2d::Zero(), force = position;
    for (int i = 0; i < 2 * steps + 2; ++i) {
        const Eigen::Vector2d way = i < steps       ? Eigen::Vector2d(yield[0], 0)
                                    : i < 2 * steps ? Eigen::Vector2d(0, delta * yield[1])
                                                    : Eigen::Vector2d(0, 0);
        const Eigen::Vector2d u = way / (steps * dt);
        const auto rows = joint.prepare({.position = position + u * dt / 2,
                                         .velocity = u,
                                         .mass = mass,
                                         .ahead = true,
                                         .before = position},
                                        dt);
        for (int k = 0; k < 2; ++k) {
            const auto& row = rows[std::size_t(k)];
            force[k] = std::clamp((row.bias - u[k]) / (row.compliance * dt), row.lower, row.upper);
        }
        position += u * dt;
        joint.commit({force, u, position}, dt);
    }
    INFO("delta " << delta);
    const double work = capacity[1] * capacity[1] / stiffness[1] * std::log(std::cosh(delta));
    CHECK(-force[0] / capacity[0] == Approx(1 / std::cosh(delta)).epsilon(0.005));
    CHECK(-force[1] / capacity[1] == Approx(std::tanh(delta)).epsilon(0.005));
    CHECK(joint.state().plastic_work == Approx(work).epsilon(0.005));
}

TEST_CASE("half a step ahead, the damper of an elastic row is of second order", "[coupled_joint]") {
    // x'' + ω² τ x' + ω² x = 0, thrown, for three swings at ω h = 0.2 and 0.1
    constexpr double m = 2, k = 2e6, omega = 1e3, tau = 1e-4, time = 0.02, speed = 1;
    const double decay = omega * omega * tau / 2, own = std::sqrt(omega * omega - decay * decay);
    const double exact = speed / own * std::exp(-decay * time) * std::sin(own * time);
    double off = 0;
    for (const double h : {2e-4, 1e-4}) {
        CoupledJoint joint(Ellipse({.capacity = V2(1e9, 1e9)}), Perfect<double>({.strength = 1}),
                           TravelLimit<double>(),
                           {.stiffness = V2(k, k), .damping_time = V2(tau, 0)});
        double x = 0, u = speed, damped = 0;
        for (int i = 0; i < int(std::lround(time / h)); ++i) {
            const auto rows = joint.prepare({.position = V2(x + u * h / 2, 0),
                                             .velocity = V2(u, 0),
                                             .mass = m * Eigen::Matrix2d::Identity(),
                                             .ahead = true,
                                             .before = V2(x, 0)},
                                            h);
            const double impulse = (rows[0].bias - u) / (1 / m + rows[0].compliance);
            const double after = u + impulse / m;
            x += (u + after) / 2 * h;
            damped += joint.commit({V2(impulse / h, 0), V2(after, 0), V2(x, 0)}, h).damped;
            u = after;
        }
        const double now = std::abs(x - exact);
        CAPTURE(h, x, exact);
        if (off > 0) CHECK(now == Approx(off / 4).epsilon(0.1));
        off = now;
        const double left = m * u * u / 2 + joint.state().stored;
        CHECK(left + damped == Approx(m * speed * speed / 2).epsilon(1e-9));
    }
    CHECK(off < 0.01 * speed / omega);
}

TEST_CASE("rows that are damped otherwise flow along the normal of their surface",
          "[coupled_joint]") {
    // dragged on with one velocity the force is the one whose normal that is
    const V2 capacity(40, 30), u(0.3, -0.4), tau(1e-4, 3e-6);
    const double h = GENERATE(1e-5, 7e-5, 1e-3);
    CoupledJoint joint(Ellipse({.capacity = capacity}), Perfect<double>({.strength = 1}),
                       TravelLimit<double>(), {.stiffness = V2(4e5, 3e5), .damping_time = tau});
    V2 x = V2::Zero(), force = x;
    for (int i = 0; i < 2000; ++i) {
        static_cast<void>(joint.prepare({.position = x + u * h / 2,
                                         .velocity = u,
                                         .mass = 1e3 * Eigen::Matrix2d::Identity(),
                                         .ahead = true,
                                         .before = x},
                                        h));
        const auto rows = *joint.meet_surface(h);
        Vector6<double> wanted = Vector6<double>::Zero(), metric = wanted;
        for (int k = 0; k < 2; ++k) {
            const auto& row = rows[std::size_t(k)];
            metric[k] = row.compliance;
            wanted[k] = (row.bias - u[k]) / (row.compliance * h);
        }
        force = solve::closest_on_ellipsoid(wanted, metric, capacity.data(), 2).point.head<2>();
        x += u * h;
        joint.commit({force, u, x, true}, h);
    }
    const V2 held =
        -capacity.cwiseProduct(capacity).cwiseProduct(u) / capacity.cwiseProduct(u).norm();
    CHECK(force[0] == Approx(held[0]).epsilon(1e-6));
    CHECK(force[1] == Approx(held[1]).epsilon(1e-6));
}

TEST_CASE("six axes with one life: random loads create no energy, no NaN, no mending",
          "[coupled_joint]") {
    using V6 = Eigen::Matrix<double, 6, 1>;
    V6 capacity, mass;
    capacity << 50, 60, 70, 10, 12, 8;
    mass << 5, 5, 5, 0.3, 0.4, 0.2;
    Body body(CoupledJoint(Ellipsoid<double, 6>({.capacity = capacity}),
                           Perfect<double>({.strength = 12}), TravelLimit<double>({.limit = 60})),
              mass);
    unsigned seed = 7;
    double last = 0, used = 0;
    int flowing = 0;
    bool broken = false;
    V6 load = V6::Zero();
    for (int i = 0; i < 40000; ++i) {
        for (int axis = 0; axis < 6; ++axis) { // noise that remembers for some 50 steps
            seed = seed * 1664525u + 1013904223u;
            const double noise = double(seed >> 8) / double(1u << 24) - 0.5;
            load[axis] += 0.02 * (20 * noise * capacity[axis] - load[axis]);
        }
        body.step(0.002, load);
        REQUIRE(body.velocity.allFinite());
        REQUIRE(body.joint.state().plastic_work >= last);
        REQUIRE((!broken || body.joint.state().broken));
        last = body.joint.state().plastic_work;
        broken = body.joint.state().broken;
        if (broken) continue;
        // one step may leave the surface through a corner of the box, by at most √6
        REQUIRE(body.joint.utilisation() < std::sqrt(6.0));
        if (body.joint.state().flowing) {
            used += body.joint.utilisation();
            ++flowing;
        }
    }
    CHECK(broken);
    CHECK(used / flowing == Approx(1).epsilon(0.02)); // and on the mean it is on the surface
    CHECK(last == Approx(12 * 60).epsilon(1e-9));
}

TEST_CASE("a saved and restored coupled joint goes on bit for bit", "[coupled_joint]") {
    Body a(ellipse_joint(40, 30, 2), V2(2, 1));
    a.velocity = V2(5, 6);
    for (int i = 0; i < 9; ++i) a.step(0.01);
    Body b(ellipse_joint(40, 30, 2), V2(2, 1));
    b.joint.restore(a.joint.state());
    b.position = a.position;
    b.velocity = a.velocity;
    for (int i = 0; i < 50; ++i) {
        a.step(0.01);
        b.step(0.01);
        REQUIRE(a.joint.state() == b.joint.state());
    }
}

TEST_CASE("rotation vectors add up over many turns", "[rotation]") {
    RotationTracker<double> tracker;
    const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 2) / 3;
    for (int i = 1; i <= 100; ++i) {
        tracker.follow(Eigen::AngleAxisd(0.7 * i, axis).toRotationMatrix());
    }
    CHECK((tracker.total - 70 * axis).norm() < 1e-10);
    CHECK(rotation_vector<double>(Eigen::Matrix3d::Identity()).norm() == 0);
    const Eigen::Matrix3d half = Eigen::AngleAxisd(std::numbers::pi, axis).toRotationMatrix();
    CHECK(rotation_vector<double>(half).norm() == Approx(std::numbers::pi).epsilon(1e-9));
    const Eigen::Matrix3d tiny = Eigen::AngleAxisd(1e-9, axis).toRotationMatrix();
    CHECK((rotation_vector<double>(tiny) - 1e-9 * axis).norm() < 1e-17);
}

TEST_CASE("a coupled joint refuses parameters that make none, by name", "[coupled_joint]") {
    const Ellipse surface({.capacity = V2(1, 1)});
    const Perfect<double> law({.strength = 1});
    CHECK(message_of([&] {
              CoupledJoint(surface, law, TravelLimit<double>(), {.stiffness = V2(1, -1)});
          }) == "CoupledJoint.stiffness[1] = -1 N/m or N m/rad: must be > 0 (infinity: no limit)");
    CHECK(message_of([&] {
              CoupledJoint(surface, law, TravelLimit<double>(), {.drift_time = 0});
          }) == "CoupledJoint.drift_time = 0 s: must be finite and > 0");
}
