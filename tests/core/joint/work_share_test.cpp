// SPDX-License-Identifier: MIT
//
// Rows that stop in one long step drive each other: what their joints absorb together is what the
// bodies lost.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/work_share.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "ductile/world/share_work.hpp"
#include "reference/beam.hpp"
#include "reference/pair_world.hpp"
#include "reference/world.hpp"

using namespace ductile;
using reference::Beam;
using reference::Body;
using reference::World;

namespace {

using Hinge = OneAxisJoint<Perfect<double>>;

/// What all joints of a step did, and the least and largest share of one [J].
struct Sums {
    double plastic = 0, other = 0, least = 0, most = 0;

    void add(const Step<double>& step) {
        plastic += step.plastic_work;
        other += step.other_work;
        least = std::min(least, step.plastic_work);
        most = std::max(most, step.plastic_work);
    }
};

} // namespace

TEST_CASE("ten uniform rods struck at the tip absorb in one long step what they had",
          "[joint][share]") {
    Beam<double> beam({.length = 2, .mass_per_length = 10, .plastic_moment = 400, .segments = 10});
    auto impulse = beam.world().no_load();
    beam.add_force(impulse, 2, 20);
    beam.world().strike(impulse);
    const double had = beam.world().kinetic_energy();
    beam.world().step(1.0 / 30);
    const double lost = had - beam.world().kinetic_energy();
    REQUIRE(lost > 0.5 * had);
    Sums sums;
    for (std::size_t i = 0; i < beam.hinges(); ++i) sums.add(beam.world().last(i));
    INFO("had " << had << " J, other " << sums.other << " J");
    CHECK(sums.plastic + sums.other == Approx(lost).epsilon(1e-9));
    CHECK(sums.plastic == Approx(lost).epsilon(1e-9));
    CHECK(sums.least >= 0);
    CHECK(sums.most < lost);
    double life = 0;
    for (std::size_t i = 0; i < beam.hinges(); ++i) {
        life += beam.hinge(i).state().plastic_travel * 400;
    }
    CHECK(life == Approx(lost).epsilon(1e-9));
}

TEST_CASE("joints of any chain never absorb more than their bodies lost", "[joint][share]") {
    std::mt19937 random(20240229);
    const auto number = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int shared = 0, alone = 0;
    for (int run = 0; run < 400; ++run) {
        World<double> world;
        std::deque<Hinge> hinges;
        Body before = reference::ground;
        const int length = 1 + run % 12;
        const bool elastic = run % 3 == 0;
        for (int i = 0; i < length; ++i) {
            const double mass = std::pow(10, number(-1, 1));
            const Body next = world.add_body(mass, mass * number(0.02, 0.5), {i + 0.5, 0.0});
            world.add_pin(before, next, {double(i), 0.0});
            const double k = elastic ? 1e7 : std::numeric_limits<double>::infinity();
            hinges.emplace_back(Perfect<double>({.strength = std::pow(10, number(0, 3))}),
                                TravelLimit<double>(), OneAxisParameters<double>{.stiffness = k});
            world.add_hinge(before, next, hinges.back());
            before = next;
        }
        auto impulse = world.no_load();
        for (int i = 0; i < int(impulse.size()); ++i) impulse[i] = number(-3, 3);
        world.strike(impulse);
        const double first = world.kinetic_energy();
        const double dt = std::pow(10, number(-3, -1));
        for (int step = 0; step < 4; ++step) {
            const double had = world.kinetic_energy();
            world.step(dt);
            Sums sums;
            double stored = 0, claimed = 0;
            for (int i = 0; i < length; ++i) {
                const Step<double>& last = world.last(std::size_t(i));
                sums.add(last);
                stored += last.elastic;
                claimed += last.claimed;
            }
            const double taken = had - world.kinetic_energy() - stored;
            INFO("run " << run << ", step " << step << ", " << length << " rods, dt = " << dt);
            CHECK(sums.least >= 0);
            CHECK(sums.plastic <= std::max(taken, 0.0) + 1e-8 * first);
            CHECK(sums.plastic + sums.other == Approx(taken).margin(1e-8 * first));
            const bool less = sums.plastic < claimed * (1 - 1e-9);
            (less ? shared : alone) += 1;
            if (length == 1) CHECK_FALSE(less);
        }
    }
    CHECK(shared > 100);
    CHECK(alone > 100);
}

TEST_CASE("a joint that stands still may be in no island, whatever an engine calls that",
          "[joint][share]") {
    struct Joint final : SharesWork {
        Step<double> step{};
        bool acts = true;
        double granted = 1;
        [[nodiscard]] const Step<double>* booked() const noexcept override {
            return acts ? &step : nullptr;
        }
        void grant(double share) noexcept override { granted = share; }
    } moves, stands;
    moves.step.claimed = 2;
    moves.step.unclaimed = -1;
    stands.acts = false;
    const std::vector<Joint*> joints{&stands, &moves};
    share_work(std::span<Joint* const>(joints), [] {
        return std::vector{std::numeric_limits<std::size_t>::max(), std::size_t(3)};
    });
    CHECK(moves.granted == 0.5);
    CHECK(stands.granted == 1);
}

TEST_CASE("a joint of six axes alone absorbs no more than its bodies lost", "[joint][share]") {
    using V3 = Vector3<double>;
    Vector6<double> capacity;
    capacity << 900, 700, 1200, 400, 600, 300;
    std::mt19937 random(7);
    const auto vector = [&random](double size) {
        std::uniform_real_distribution<double> number(-size, size);
        return V3(number(random), number(random), number(random));
    };
    int shared = 0;
    for (int run = 0; run < 200; ++run) {
        BodyState<double> a{.position = vector(1),
                            .velocity = vector(5),
                            .spin = vector(20),
                            .inverse_mass = 0.5,
                            .inverse_inertia = Matrix3<double>::Identity() / 0.3};
        const CoupledJoint joint(Ellipsoid<double, 6>({.capacity = capacity}),
                                 Perfect<double>({.strength = 1}));
        reference::PairWorld world(a, BodyState<double>{},
                                   Link(joint, all_joint_axes, {V3(-a.position)}, {}));
        const double had = world.kinetic_energy();
        world.step(run % 2 == 0 ? 1.0 / 10 : 1.0 / 60);
        const Step<double>& last = world.link().last();
        const double taken = had - world.kinetic_energy();
        INFO("run " << run);
        CHECK(last.plastic_work <= taken * (1 + 1e-9));
        CHECK(last.plastic_work + last.other_work == Approx(taken).epsilon(1e-9));
        shared += last.plastic_work < last.claimed * (1 - 1e-9);
    }
    CHECK(shared > 0);
}
