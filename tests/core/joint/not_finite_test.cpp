// SPDX-License-Identifier: MIT
//
// Input that is not finite: the joint says so, keeps its state, asks for no force, and goes on with
// the next step as if it had never been shown the bad one.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "ductile/batch/batch_storage.hpp"
#include "ductile/batch/one_axis_batch.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/planar_release.hpp"
#include "ductile/joint/rotation.hpp"
#include "ductile/law/hardening.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double dt = 0.01;

template <class S>
std::array<S, 3> bad_numbers() {
    return {std::numeric_limits<S>::quiet_NaN(), S(infinity), S(-infinity)};
}

template <class S>
bool is_number(const RowLimits<S>& row) {
    return std::isfinite(row.lower) && std::isfinite(row.upper) && std::isfinite(row.bias) &&
           std::isfinite(row.compliance);
}

template <class Step>
void require_told(const Step& step) {
    CHECK(step.outcome == Outcome::unreliable);
    CHECK(step.residual == infinity);
    CHECK(step.plastic_work == 0);
    CHECK(step.elastic == 0);
    CHECK(step.other_work == 0);
    CHECK_FALSE(step.fracture);
}

/// Steps `joint` once with good numbers, of which one entry is bad, and then with good ones alone.
/// `spoil(motion, reaction)` puts it there.
template <class Joint, class Spoil>
void check_one_axis(Joint joint, bool before_the_solve, Spoil spoil) {
    using S = typename Joint::Scalar;
    Motion<S> motion{S(0.02), S(3), S(2)};
    Reaction<S> reaction{S(-40), S(2.8), S(0.049)};
    const auto step = [](Joint& of, const Motion<S>& m, const Reaction<S>& r) {
        const auto row = of.prepare(m, S(dt));
        CHECK(is_number(row));
        return std::pair(row, of.commit(r, S(dt)));
    };
    step(joint, {S(0), S(3.2), S(2)}, {S(-40), S(3), S(0.02)});
    REQUIRE_FALSE(joint.state().broken);
    const auto kept = joint.state();
    Joint never_saw_it = joint;

    Motion<S> bad_motion = motion;
    Reaction<S> bad_reaction = reaction;
    spoil(bad_motion, bad_reaction);
    const auto [row, told] = step(joint, bad_motion, bad_reaction);
    require_told(told);
    CHECK(joint.state() == kept);
    if (before_the_solve) CHECK(row == RowLimits<S>{.lower = 0, .upper = 0});

    const auto [row_after, after] = step(joint, motion, reaction);
    const auto [row_wanted, wanted] = step(never_saw_it, motion, reaction);
    CHECK(row_after == row_wanted);
    CHECK(after.outcome == wanted.outcome);
    CHECK(joint.state() == never_saw_it.state());
}

template <class Joint>
void check_one_axis(const Joint& joint, bool reads_mass) {
    using S = typename Joint::Scalar;
    for (const S bad : bad_numbers<S>()) {
        CAPTURE(bad);
        check_one_axis(joint, true, [bad](auto& motion, auto&) { motion.position = bad; });
        check_one_axis(joint, true, [bad](auto& motion, auto&) { motion.velocity = bad; });
        if (reads_mass && !(bad > 0)) { // infinite: driven
            check_one_axis(joint, true, [bad](auto& motion, auto&) { motion.mass = bad; });
        }
        check_one_axis(joint, false, [bad](auto&, auto& reaction) { reaction.force = bad; });
        check_one_axis(joint, false, [bad](auto&, auto& reaction) { reaction.velocity = bad; });
        check_one_axis(joint, false, [bad](auto&, auto& reaction) { reaction.position = bad; });
    }
}

constexpr int six = 6;
template <class S>
using Six = CoupledJoint<Ellipsoid<S, six>, Perfect<S>>;

template <class S>
Six<S> coupled(S stiffness) {
    return Six<S>(Ellipsoid<S, six>({.capacity = Vector6<S>::Constant(40)}),
                  Perfect<S>({.strength = 40}), TravelLimit<S>({.limit = 1}),
                  {.stiffness = Vector6<S>::Constant(stiffness)});
}

template <class S, class Spoil>
void check_coupled(Six<S> joint, bool before_the_solve, Spoil spoil) {
    using Joint = Six<S>;
    typename Joint::Motion motion{.position = Vector6<S>::Constant(S(0.02)),
                                  .velocity = Vector6<S>::Constant(3)};
    typename Joint::Reaction reaction{.force = Vector6<S>::Constant(-16),
                                      .velocity = Vector6<S>::Constant(S(2.8)),
                                      .position = Vector6<S>::Constant(S(0.049))};
    const auto step = [](Joint& of, const auto& m, const auto& r) {
        const auto rows = of.prepare(m, S(dt));
        for (const auto& row : rows) CHECK(is_number(row));
        return std::pair(rows, of.commit(r, S(dt)));
    };
    step(joint, typename Joint::Motion{.velocity = Vector6<S>::Constant(S(3.2))},
         typename Joint::Reaction{reaction.force, motion.velocity, motion.position});
    REQUIRE_FALSE(joint.state().broken);
    const auto kept = joint.state();
    Joint never_saw_it = joint;

    auto bad_motion = motion;
    auto bad_reaction = reaction;
    spoil(bad_motion, bad_reaction);
    const auto [rows, told] = step(joint, bad_motion, bad_reaction);
    require_told(told);
    CHECK(joint.state() == kept);
    if (before_the_solve) {
        for (const auto& row : rows) CHECK(row == RowLimits<S>{.lower = 0, .upper = 0});
    }

    const auto [rows_after, after] = step(joint, motion, reaction);
    const auto [rows_wanted, wanted] = step(never_saw_it, motion, reaction);
    CHECK(rows_after == rows_wanted);
    CHECK(after.outcome == wanted.outcome);
    CHECK(joint.state() == never_saw_it.state());
}

template <class S>
void check_coupled(S stiffness) {
    const Six<S> joint = coupled(stiffness);
    for (const S bad : bad_numbers<S>()) {
        for (const int i : {0, 2, 5}) {
            CAPTURE(bad, i, stiffness);
            check_coupled<S>(joint, true, [=](auto& motion, auto&) { motion.position[i] = bad; });
            check_coupled<S>(joint, true, [=](auto& motion, auto&) { motion.velocity[i] = bad; });
            check_coupled<S>(joint, true, [=](auto& motion, auto&) { motion.mass(i, 1) = bad; });
            check_coupled<S>(joint, false, [=](auto&, auto& reaction) { reaction.force[i] = bad; });
            check_coupled<S>(joint, false,
                             [=](auto&, auto& reaction) { reaction.velocity[i] = bad; });
            check_coupled<S>(joint, false,
                             [=](auto&, auto& reaction) { reaction.position[i] = bad; });
        }
    }
}

using Body = BodyState<double>;
using Hinge = OneAxisJoint<Perfect<double>>;

/// A wheel about z on the ground, slowed by 40 N m for one step.
template <class Joint>
struct Wheel {
    explicit Wheel(const Link<Joint>& joint) : link(joint) {
        a.inverse_mass = 1;
        a.inverse_inertia.setIdentity();
        a.spin = {0, 0, 3};
        link.start(a, ground);
    }
    void solve() {
        a.spin.z() -= 40 * dt;
        a.orientation = turned_by<double>(Vector3<double>(0, 0, a.spin.z() * dt), a.orientation);
    }
    void step(Vector6<double> forces = brake()) {
        link.prepare(a, ground, dt, 20);
        solve();
        link.commit_rows(a, ground, forces, dt);
    }
    static Vector6<double> brake() {
        Vector6<double> forces = Vector6<double>::Zero();
        forces[5] = -40;
        return forces;
    }

    Link<Joint> link;
    Body a, ground;
};

/// One body is spoiled, before the solve or by it, or one of the forces.
template <class Joint, class Spoil>
void check_link(const Link<Joint>& link, bool before_the_solve, Spoil spoil) {
    Wheel<Joint> wheel(link);
    wheel.step();
    const auto kept = wheel.link.state();
    const Vector6<double> forces_kept = wheel.link.forces();
    Wheel<Joint> never_saw_it = wheel;

    Body a = wheel.a, b = wheel.ground;
    Vector6<double> forces = Wheel<Joint>::brake();
    if (before_the_solve) spoil(a, b, forces);
    wheel.link.teleport(a, b);
    wheel.link.prepare(a, b, dt, 20);
    for (const JointAxis axis : all_joint_axes) {
        const RowLimits<double> row = wheel.link.row(axis).limits;
        CHECK_FALSE(std::isnan(row.lower));
        CHECK_FALSE(std::isnan(row.upper));
        CHECK(std::isfinite(row.bias));
    }
    spoil(a, b, forces);
    require_told(wheel.link.commit_rows(a, b, forces, dt));
    CHECK(wheel.link.outcome() == Outcome::unreliable);
    CHECK(wheel.link.rigid_residual() == infinity);
    CHECK(wheel.link.state() == kept);
    CHECK(wheel.link.forces() == forces_kept);

    wheel.link.teleport(wheel.a, wheel.ground);
    wheel.step();
    never_saw_it.step();
    CHECK(wheel.link.outcome() == never_saw_it.link.outcome());
    CHECK(wheel.link.state() == never_saw_it.link.state());
}

template <class Joint>
void check_link(const Link<Joint>& link) {
    const std::vector<std::function<void(Body&, double)>> spoils = {
        [](Body& body, double bad) { body.position[1] = bad; },
        [](Body& body, double bad) { body.velocity[2] = bad; },
        [](Body& body, double bad) { body.spin[0] = bad; },
        [](Body& body, double bad) { body.spin[2] = bad; },
        [](Body& body, double bad) { body.orientation(0, 0) = bad; },
        [](Body& body, double bad) { body.orientation(2, 1) = bad; },
        [](Body& body, double bad) { body.orientation.setConstant(bad); },
    };
    for (const double bad : bad_numbers<double>()) {
        for (const bool before : {true, false}) {
            for (std::size_t i = 0; i < spoils.size(); ++i) {
                CAPTURE(bad, i, before);
                check_link(link, before, [&](Body& a, Body&, auto&) { spoils[i](a, bad); });
                check_link(link, before, [&](Body&, Body& b, auto&) { spoils[i](b, bad); });
            }
        }
        for (const int i : {0, 1, 5}) {
            CAPTURE(bad, i);
            check_link(link, false, [&](Body&, Body&, auto& forces) { forces[i] = bad; });
        }
    }
}

} // namespace

TEST_CASE("the spring between driven bodies is ruled and booked", "[joint][not_finite]") {
    // nothing moves them: the force is the spring's at the start of the step
    OneAxisJoint<Perfect<double>> joint(Perfect<double>({.strength = 40}), {}, {.stiffness = 1000});
    for (int i = 0; i < 2; ++i) {
        const double from = 0.01 * i, to = from + 0.01;
        const RowLimits<double> row = joint.prepare({from, 1, infinity}, dt);
        REQUIRE(is_number(row));
        CHECK(row.lower == Approx(-1000 * from));
        CHECK(row.upper == row.lower);
        const Step<double> step = joint.commit({row.lower, 1, to}, dt);
        CHECK(step.outcome != Outcome::unreliable);
        CHECK(step.elastic == Approx(1000 * (to * to - from * from) / 2));
    }
    CHECK(joint.state().stored == Approx(0.2));
}

TEST_CASE("a one-axis joint keeps its state where a number is not finite, and says so",
          "[joint][not_finite]") {
    check_one_axis(
        OneAxisJoint(Perfect<double>({.strength = 40}), TravelLimit<double>({.limit = 1})), false);
    check_one_axis(OneAxisJoint(Perfect<float>({.strength = 40}), TravelLimit<float>({.limit = 1})),
                   false);
    check_one_axis(OneAxisJoint(Linear<double>({.strength = 40, .hardening = 5}),
                                TravelLimit<double>({.limit = 1}), {.stiffness = 4000}),
                   true);
    check_one_axis(OneAxisJoint(Perfect<double>({.strength = 40}),
                                TravelLimit<double>({.limit = 1}), {.stiffness = 4e6}),
                   true);
}

TEST_CASE("a step of no finite length is not booked", "[joint][not_finite]") {
    for (const double bad : bad_numbers<double>()) {
        OneAxisJoint joint(Perfect<double>({.strength = 40}));
        CHECK(is_number(joint.prepare({0, 3}, bad)));
        require_told(joint.commit({-40, 2.8, 0.03}, bad));
        CHECK(joint.state() == OneAxisJoint(Perfect<double>({.strength = 40})).state());
    }
}

TEST_CASE("numbers whose product leaves the range are not booked either", "[joint][not_finite]") {
    OneAxisJoint joint(Perfect<float>({.strength = 1e30f}));
    (void)joint.prepare({0, 1e20f}, 0.01f);
    require_told(joint.commit({-1e30f, 1e20f, 1e18f}, 0.01f));
    CHECK(joint.state() == OneAxisJoint(Perfect<float>({.strength = 1e30f})).state());
}

TEST_CASE("a coupled joint keeps its state where a number is not finite, and says so",
          "[joint][not_finite]") {
    check_coupled<double>(infinity);
    check_coupled<double>(4e3);
    check_coupled<double>(4e6);
    check_coupled<float>(float(infinity));
}

TEST_CASE("a link keeps its state where a body or a force is not finite, and says so",
          "[joint][not_finite]") {
    check_link(Link<Hinge>(Hinge(Perfect<double>({.strength = 40})), {JointAxis::torsion}, {}, {}));
    check_link(Link<Hinge>(Hinge(Perfect<double>({.strength = 40}), {}, {.stiffness = 4e3}),
                           {JointAxis::torsion}, {}, {}));
    check_link(Link<Six<double>>(coupled<double>(infinity), all_joint_axes, {}, {}));
}

TEST_CASE("the joints of a batch keep their states where a number is not finite, and say so",
          "[batch][not_finite]") {
    const auto law = batch_law(Perfect<float>({.strength = 40}), TravelLimit<float>({.limit = 1}));
    constexpr std::size_t joints = 5, spoiled = 2;
    for (const float bad : bad_numbers<float>()) {
        for (int entry = 0; entry < 5; ++entry) {
            CAPTURE(bad, entry);
            BatchStorage<float> memory(joints);
            OneAxisBatch batch(law, memory.arrays());
            const auto step = [&](float velocity, int at) {
                for (std::size_t i = 0; i < joints; ++i) {
                    const bool here = i == spoiled;
                    memory.position[i] = here && at == 0 ? bad : 0.02f;
                    memory.velocity[i] = here && at == 1 ? bad : velocity;
                }
                batch.prepare(float(dt));
                for (std::size_t i = 0; i < joints; ++i) {
                    const bool here = i == spoiled;
                    CHECK(std::isfinite(memory.lower[i] + memory.upper[i] + memory.bias[i]));
                    memory.force[i] = here && at == 2 ? bad : -40;
                    memory.velocity_after[i] = here && at == 3 ? bad : velocity - 0.2f;
                    memory.position_after[i] = here && at == 4 ? bad : 0.02f + velocity * float(dt);
                }
                batch.commit(float(dt));
            };
            step(3, -1);
            const auto kept = batch.state(spoiled);
            const auto neighbour = batch.state(spoiled + 1);
            step(2.8f, entry);
            CHECK(batch.outcome(spoiled) == Outcome::unreliable);
            CHECK(memory.residual[spoiled] == float(infinity));
            CHECK(memory.release[spoiled] == 0);
            auto now = batch.state(spoiled);
            now.start_velocity = kept.start_velocity; // shared by prepare and commit
            CHECK(now == kept);
            CHECK(batch.outcome(spoiled + 1) == Outcome::yielding);
            CHECK(batch.state(spoiled + 1).plastic_work > neighbour.plastic_work);
            step(2.8f, -1);
            CHECK(batch.outcome(spoiled) == Outcome::yielding);
            CHECK(batch.state(spoiled).plastic_work == Approx(2 * kept.plastic_work).epsilon(0.1));
        }
    }
}

TEST_CASE("a rotation that is not finite is not followed", "[joint][not_finite]") {
    for (const double bad : bad_numbers<double>()) {
        RotationTracker<double> tracker;
        tracker.follow(turned_by<double>({0, 0, 0.1}, Matrix3<double>::Identity()));
        const auto kept = tracker;
        Matrix3<double> spoiled = tracker.last;
        spoiled(1, 2) = bad;
        CHECK_FALSE(is_finite(tracker.follow(spoiled)));
        CHECK(tracker == kept);
    }
}

TEST_CASE("a hinge of the plane is given nothing back where a number is not finite",
          "[joint][not_finite]") {
    for (const double bad : bad_numbers<double>()) {
        for (int entry = 0; entry < 4; ++entry) {
            PlanarBody<double> a{1, 2, 0.5, 0, {0, 0, 3}};
            double energy = 4;
            (entry == 0   ? a.velocity.x
             : entry == 1 ? a.velocity.spin
             : entry == 2 ? a.arm_y
                          : energy) = bad;
            const auto back = planar_release(a, {}, energy);
            CHECK(back.a.x == 0);
            CHECK(back.a.y == 0);
            CHECK(back.a.spin == 0);
        }
    }
}
