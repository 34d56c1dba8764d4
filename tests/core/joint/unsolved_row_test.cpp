// SPDX-License-Identifier: MIT
//
// What a solver leaves undone is work that somebody did, and nobody's flow: it uses up no life, is
// no yield and breaks nothing, however large it is.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "ductile/batch/batch_storage.hpp"
#include "ductile/batch/one_axis_batch.hpp"
#include "ductile/fracture/travel_limit.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double dt = 1.0 / 60, strength = 10, mass = 2;

/// A joint that holds 4 of its 10 N, and a solver that lets it move at 3 m/s all the same: 100
/// steps.
template <class Joint>
void check_unhurt(const Joint& joint, double work) {
    CHECK(joint.state().plastic_work == 0);
    CHECK(joint.state().plastic_travel == 0);
    CHECK_FALSE(joint.state().broken);
    CHECK(joint.state().other_work + joint.state().stored == Approx(work).epsilon(1e-9));
}

} // namespace

TEST_CASE("an unsolved row of one axis uses up no life", "[joint][unsolved]") {
    const double stiffness = GENERATE(values<double>({infinity, 1e5, 1e6}));
    const double force = GENERATE(-4.0, 4.0, -10.0);
    OneAxisJoint<Perfect<double>> joint(Perfect<double>({.strength = strength}),
                                        TravelLimit<double>({.limit = 0.1}),
                                        {.stiffness = stiffness});
    INFO("k = " << stiffness << ", f = " << force);
    double q = 0, work = 0;
    for (int i = 0; i < 100; ++i) {
        static_cast<void>(joint.prepare({q, 3, mass}, dt));
        // away from the bound, or at the bound that should push the other way
        const double speed = force == -10 ? -3 : 3;
        q += speed * dt;
        const auto step = joint.commit({force, speed, q}, dt);
        work -= force * (3 + speed) / 2 * dt;
        CHECK(step.outcome == Outcome::unreliable);
        CHECK_FALSE(step.first_yield);
    }
    check_unhurt(joint, work);
}

TEST_CASE("an unsolved row of several axes uses up no life", "[joint][unsolved]") {
    using Joint = CoupledJoint<Ellipsoid<double, 2>, Perfect<double>>;
    const double stiffness = GENERATE(values<double>({infinity, 1e6}));
    const bool on_surface = GENERATE(false, true);
    INFO("k = " << stiffness << (on_surface ? ", on the surface" : ""));
    CoupledParameters<double, 2> parameters;
    parameters.stiffness.setConstant(stiffness);
    Joint joint(Ellipsoid<double, 2>({.capacity = {strength, strength}}),
                Perfect<double>({.strength = strength}), TravelLimit<double>({.limit = 0.1}),
                parameters);
    const Joint::Vector speed(3, -1), force(-4, 2);
    Joint::Vector q = Joint::Vector::Zero();
    double work = 0;
    for (int i = 0; i < 100; ++i) {
        static_cast<void>(joint.prepare({q, speed, mass * Joint::Matrix::Identity()}, dt));
        q += speed * dt;
        const auto step = joint.commit({force, speed, q, on_surface}, dt);
        work -= force.dot(speed) * dt;
        CHECK(step.outcome == Outcome::unreliable);
    }
    check_unhurt(joint, work);
}

TEST_CASE("an unsolved row of a batch uses up no life", "[batch][unsolved]") {
    BatchStorage<double> memory(1);
    OneAxisBatch batch(batch_law(Perfect<double>({.strength = strength})), memory.arrays());
    for (int i = 0; i < 100; ++i) {
        memory.velocity[0] = 3;
        batch.prepare(dt);
        memory.force[0] = -4;
        memory.velocity_after[0] = 3;
        memory.position_after[0] = memory.position[0] + 3 * dt;
        batch.commit(dt);
        memory.position[0] = memory.position_after[0];
        CHECK(batch.outcome(0) == Outcome::unreliable);
    }
    CHECK(memory.plastic_work[0] == 0);
    CHECK(memory.plastic_travel[0] == 0);
}
