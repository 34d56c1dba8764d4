// SPDX-License-Identifier: MIT
//
// The batch against the scalar joint, which is the reference: every field, to round-off.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "ductile/batch/batch_storage.hpp"
#include "ductile/batch/one_axis_batch.hpp"
#include "support/property.hpp"
#include "support/throws.hpp"

using namespace ductile;
using ductile::test::message_of;

namespace {

/// Equal to the round-off of a history: the scalar joint integrates its law by other operations.
template <class S>
bool same(S a, S b) {
    const S scale = std::max({S(1), std::abs(a), std::abs(b)});
    return a == b || std::abs(a - b) <= (sizeof(S) == 4 ? S(2e-4) : S(1e-11)) * scale;
}

template <class S>
using State = typename OneAxisJoint<Perfect<S>>::State;

template <class S, class OtherState>
bool same(const State<S>& a, const OtherState& b) {
    return same(a.plastic_offset, b.plastic_offset) && same(a.plastic_travel, b.plastic_travel) &&
           same(a.plastic_work, b.plastic_work) && same(a.other_work, b.other_work) &&
           same(a.start_velocity, b.start_velocity) && same(a.velocity, b.velocity) &&
           same(a.residual_max, b.residual_max) && a.flowing == b.flowing && a.broken == b.broken;
}

/// Counts what the histories went through: a comparison proves nothing about a case never met.
struct Seen {
    int yielding = 0, broken = 0, released = 0, clipped = 0, unreliable = 0, elastic = 0, began = 0;
};

/// Masses on one joint each, driven by random loads, kicks, jitter and unsolved rows; each is
/// stepped on the numbers of its scalar joint, and the batch has to ask for and book the same.
template <class S, class Law, class Joint>
Seen compare(OneAxisBatch<Law> batch, BatchStorage<S>& memory, std::vector<Joint> joints,
             unsigned seed, int steps) {
    std::mt19937 random(seed);
    const auto uniform = [&](S low, S high) {
        return low + (high - low) * S(random() >> 8) / S(1u << 24);
    };
    Seen seen;
    for (int n = 0; n < steps; ++n) {
        const S dt = uniform(S(0.001), S(0.05));
        std::vector<Motion<S>> motion(joints.size());
        std::vector<RowLimits<S>> rows(joints.size());
        for (std::size_t i = 0; i < joints.size(); ++i) {
            if (random() % 8 == 0) memory.velocity_after[i] += uniform(-3, 3);             // a kick
            if (random() % 4 == 0) memory.velocity_after[i] += uniform(S(-1e-5), S(1e-5)); // jitter
            memory.position[i] = memory.position_after[i];
            memory.velocity[i] = memory.velocity_after[i];
            motion[i] = {memory.position[i], memory.velocity[i]};
            rows[i] = joints[i].prepare(motion[i], dt);
        }
        batch.prepare(dt);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            INFO("step " << n << ", joint " << i);
            REQUIRE(same(memory.lower[i], rows[i].lower));
            REQUIRE(same(memory.upper[i], rows[i].upper));
            REQUIRE(same(memory.bias[i], rows[i].bias));
            const S full = joints[i].strength();
            seen.clipped += !joints[i].state().broken && rows[i].upper < full * S(0.999);

            const S mass = S(1) + S(i % 7);
            const S free = motion[i].velocity + dt * uniform(-60, 60) / mass;
            S impulse =
                std::clamp(mass * (rows[i].bias - free), rows[i].lower * dt, rows[i].upper * dt);
            if (random() % 16 == 0) impulse *= uniform(S(-0.5), S(0.9)); // left unsolved
            if (random() % 32 == 0) impulse += uniform(S(-0.3), S(0.3)); // out of bounds
            memory.force[i] = impulse / dt;
            memory.velocity_after[i] = free + impulse / mass;
            memory.position_after[i] = memory.position[i] + memory.velocity_after[i] * dt;
        }
        batch.commit(dt);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            INFO("step " << n << ", joint " << i);
            const Step<S> step = joints[i].commit(
                {memory.force[i], memory.velocity_after[i], memory.position_after[i]}, dt);
            REQUIRE(same<S>(batch.state(i), joints[i].state()));
            REQUIRE(batch.outcome(i) == step.outcome);
            REQUIRE(batch.first_yield(i) == step.first_yield);
            REQUIRE(batch.fracture(i).has_value() == step.fracture);
            if (step.fracture) {
                const FractureEvent<S> mine = *batch.fracture(i), its = *joints[i].fracture();
                REQUIRE(mine.criterion == its.criterion);
                REQUIRE(same(mine.plastic_travel, its.plastic_travel));
                REQUIRE(same(mine.absorbed_energy, its.absorbed_energy));
                REQUIRE(same(mine.released_energy, its.released_energy));
                REQUIRE(same(mine.force, its.force));
                REQUIRE(mine.time >= its.time - 1e-9);
                REQUIRE(mine.time - double(dt) <= its.time + 1e-9);
            }
            seen.began += step.first_yield;
            REQUIRE(same(memory.release[i], step.release));
            REQUIRE(same(memory.residual[i], step.residual));
            seen.elastic += step.outcome == Outcome::elastic;
            seen.yielding += step.outcome == Outcome::yielding;
            seen.broken += step.outcome == Outcome::broken;
            seen.unreliable += step.outcome == Outcome::unreliable;
            seen.released += step.release > 0;
            // in float the travel left before a break keeps few digits: start each step from the
            // same
            if (sizeof(S) == 4) batch.restore(i, joints[i].state());
            memory.velocity_after[i] -=
                std::copysign(std::min(std::abs(memory.velocity_after[i]), step.release),
                              memory.velocity_after[i]); // any response to the release will do
        }
    }
    return seen;
}

} // namespace

TEMPLATE_TEST_CASE("the batch books random histories as the scalar joint does", "[batch]", float,
                   double) {
    using S = TestType;
    // 37 joints: whole registers and a remainder
    constexpr std::size_t joints = 37;
    Seen total;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        BatchStorage<S> memory(joints);
        const S limit = seed % 4 == 0 ? std::numeric_limits<S>::infinity() : S(0.2) * S(seed);
        Seen seen;
        if (seed % 2 == 0) {
            const Perfect<S> law({.strength = 25});
            const TravelLimit<S> at({.limit = limit});
            seen = compare<S>(OneAxisBatch(batch_law(law, at), memory.arrays()), memory,
                              std::vector(joints, OneAxisJoint(law, at)), seed, 250);
        } else {
            const Linear<S> law({.strength = 15, .hardening = 30});
            const TravelLimit<S> at({.limit = limit});
            seen = compare<S>(OneAxisBatch(batch_law(law, at), memory.arrays()), memory,
                              std::vector(joints, OneAxisJoint(law, at)), seed, 250);
        }
        total.elastic += seen.elastic;
        total.yielding += seen.yielding;
        total.broken += seen.broken;
        total.released += seen.released;
        total.clipped += seen.clipped;
        total.unreliable += seen.unreliable;
        total.began += seen.began;
    }
    CHECK(total.elastic > 1000);
    CHECK(total.yielding > 1000);
    CHECK(total.broken > 1000);
    CHECK(total.unreliable > 1000);
    CHECK(total.released > 300);
    CHECK(total.clipped > 300);
    CHECK(total.began > 300);
}

TEMPLATE_TEST_CASE("joints with numbers of their own in one batch", "[batch]", float, double) {
    using S = TestType;
    test::prop("any strength, hardening and limit", [] {
        const std::size_t count = *rc::gen::inRange<std::size_t>(0, 40);
        std::vector<S> strength(count), hardening(count), limit(count);
        std::vector<OneAxisJoint<Linear<S>>> joints;
        for (std::size_t i = 0; i < count; ++i) {
            strength[i] = S(*rc::gen::inRange(1, 100));
            hardening[i] = S(*rc::gen::inRange(0, 50));
            limit[i] = *rc::gen::arbitrary<bool>() ? std::numeric_limits<S>::infinity()
                                                   : S(*rc::gen::inRange(1, 100)) / 50;
            joints.emplace_back(Linear<S>({strength[i], hardening[i]}), TravelLimit<S>({limit[i]}));
        }
        BatchStorage<S> memory(count);
        const BatchLaw law(PerJoint<S>{strength}, PerJoint<S>{hardening}, PerJoint<S>{limit});
        compare<S>(OneAxisBatch(law, memory.arrays()), memory, joints,
                   *rc::gen::arbitrary<unsigned>(), 40);
    });
}

TEST_CASE("a batch longer than the block it is worked in", "[batch]") {
    // three blocks, the last one short, and one exactly full
    for (const std::size_t joints : {3 * batch_detail::block - 5, batch_detail::block}) {
        const Perfect<float> law({.strength = 25});
        const TravelLimit<float> at({.limit = 1});
        BatchStorage<float> memory(joints);
        const Seen seen = compare<float>(OneAxisBatch(batch_law(law, at), memory.arrays()), memory,
                                         std::vector(joints, OneAxisJoint(law, at)), 5, 40);
        CHECK(seen.broken > 0);
    }
}

TEST_CASE("a batch of rotors dissipates exactly the energy each can take", "[batch]") {
    // I = 2 kg m², M_p = 40 N m, ω₀ = 10 rad/s; the even ones break at 1.6 rad with 6 rad/s left
    constexpr std::size_t count = 10;
    std::vector<double> limit(count);
    for (std::size_t i = 0; i < count; ++i) limit[i] = i % 2 == 0 ? 1.6 : 3.0;
    BatchStorage<double> memory(count);
    OneAxisBatch batch(BatchLaw(Shared<double>{40}, Shared<double>{0}, PerJoint<double>{limit}),
                       memory.arrays());
    std::fill(memory.velocity.begin(), memory.velocity.end(), 10);
    const double dt = 1.0 / 240;
    for (int n = 0; n < 200; ++n) {
        batch.prepare(dt);
        for (std::size_t i = 0; i < count; ++i) {
            const double impulse = std::clamp(2 * (memory.bias[i] - memory.velocity[i]),
                                              memory.lower[i] * dt, memory.upper[i] * dt);
            memory.force[i] = impulse / dt;
            memory.velocity_after[i] = memory.velocity[i] + impulse / 2;
            memory.position_after[i] = memory.position[i] + dt * memory.velocity_after[i];
        }
        batch.commit(dt);
        for (std::size_t i = 0; i < count; ++i) {
            const double after = memory.velocity_after[i];
            memory.velocity[i] = std::sqrt(after * after + memory.release[i]); // 2 W / I, I = 2
            memory.position[i] = memory.position_after[i];
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        INFO("joint " << i);
        CHECK(memory.plastic_work[i] == Approx(i % 2 == 0 ? 64 : 100).epsilon(1e-12));
        CHECK(memory.velocity[i] == Approx(i % 2 == 0 ? 6 : 0).margin(1e-10));
        CHECK(batch.outcome(i) == (i % 2 == 0 ? Outcome::broken : Outcome::elastic));
    }
}

TEST_CASE("a joint moves between batch and scalar without losing a bit", "[batch]") {
    BatchStorage<double> memory(3);
    OneAxisBatch batch(batch_law(Perfect<double>({.strength = 1})), memory.arrays());
    State<double> state;
    state.plastic_offset = 1;
    state.plastic_travel = state.law.plastic_travel = state.criterion.travel = 2;
    state.plastic_work = 3;
    state.other_work = -4;
    state.start_velocity = 5;
    state.velocity = -6;
    state.residual_max = 7;
    state.flowing = true;
    batch.restore(1, state);
    CHECK(batch.state(1) == state);
    state.broken = true;
    batch.restore(1, state);
    CHECK(batch.state(1) == state);
    CHECK(batch.outcome(1) == Outcome::broken);
    CHECK(batch.state(0) == State<double>{});
    CHECK(batch.state(2) == State<double>{});
}

TEST_CASE("a batch refuses arrays that do not fit together, by name", "[batch]") {
    BatchStorage<double> memory(3), shorter(2);
    const auto law = batch_law(Perfect<double>({.strength = 1}));
    const auto with = [&](auto&& change) {
        BatchArrays<double> arrays = memory.arrays();
        change(arrays);
        return message_of([&] { OneAxisBatch(law, arrays); });
    };
    CHECK(with([](auto&) {}) == "nothing thrown");
    CHECK(with([&](auto& a) { a.reaction.force = shorter.force; }) ==
          "OneAxisBatch.reaction.force.size() = 2: must be 3, as motion.position.size()");
    CHECK(with([&](auto& a) { a.state.status = {}; }) ==
          "OneAxisBatch.state.status.size() = 0: must be 3, as motion.position.size()");
    CHECK(with([&](auto& a) { a.rows.lower = a.rows.upper; }) ==
          "OneAxisBatch.rows.lower overlaps rows.upper: must be memory of its own");
    CHECK(with([&](auto& a) { a.state.velocity = memory.velocity_after; }) ==
          "OneAxisBatch.reaction.velocity overlaps state.velocity: must be memory of its own");
    // arrays that nobody writes here may be one: an engine that updates in place
    CHECK(with([&](auto& a) { a.reaction.velocity = a.motion.velocity; }) == "nothing thrown");
}

TEST_CASE("every span of a batch is checked, whichever is wrong", "[batch]") {
    // each span in turn one short: the message must name that one
    BatchStorage<double> memory(3);
    const auto law = batch_law(Perfect<double>({.strength = 1}));
    const auto names = batch_detail::all_spans(memory.arrays());
    std::size_t checked = 0;
    const auto shorten = [&](auto&& member, std::size_t index) {
        BatchArrays<double> arrays = memory.arrays();
        auto& span = member(arrays);
        span = span.first(2);
        CHECK(message_of([&] { OneAxisBatch(law, arrays); }) ==
              "OneAxisBatch." + std::string(names[index].name) +
                  ".size() = 2: must be 3, as motion.position.size()");
        ++checked;
    };
    shorten(
        [](auto& a) -> auto& { return a.motion.velocity; }, 1);
    shorten(
        [](auto& a) -> auto& { return a.reaction.force; }, 2);
    shorten(
        [](auto& a) -> auto& { return a.reaction.velocity; }, 3);
    shorten(
        [](auto& a) -> auto& { return a.reaction.position; }, 4);
    shorten(
        [](auto& a) -> auto& { return a.rows.lower; }, 5);
    shorten(
        [](auto& a) -> auto& { return a.rows.upper; }, 6);
    shorten(
        [](auto& a) -> auto& { return a.rows.bias; }, 7);
    shorten(
        [](auto& a) -> auto& { return a.state.plastic_offset; }, 8);
    shorten(
        [](auto& a) -> auto& { return a.state.plastic_travel; }, 9);
    shorten(
        [](auto& a) -> auto& { return a.state.plastic_work; }, 10);
    shorten(
        [](auto& a) -> auto& { return a.state.other_work; }, 11);
    shorten(
        [](auto& a) -> auto& { return a.state.start_velocity; }, 12);
    shorten(
        [](auto& a) -> auto& { return a.state.velocity; }, 13);
    shorten(
        [](auto& a) -> auto& { return a.state.residual_max; }, 14);
    shorten(
        [](auto& a) -> auto& { return a.state.status; }, 15);
    shorten(
        [](auto& a) -> auto& { return a.step.release; }, 16);
    shorten(
        [](auto& a) -> auto& { return a.step.residual; }, 17);
    CHECK(checked == names.size() - 1); // motion.position is the measure
}

TEST_CASE("a batch refuses numbers that make no joint, by name and index", "[batch]") {
    const std::vector<double> good{1, 2, 3}, bad{1, -2, 3};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    BatchStorage<double> memory(3), longer(4);
    CHECK(message_of([&] { BatchLaw(PerJoint<double>{bad}); }) ==
          "BatchLaw.strength[1] = -2 N or N m: must be finite and > 0");
    CHECK(message_of([&] { BatchLaw(Shared<double>{nan}); }) ==
          "BatchLaw.strength = nan N or N m: must be finite and > 0");
    CHECK(message_of([&] { BatchLaw(Shared<double>{1}, PerJoint<double>{bad}); }) ==
          "BatchLaw.hardening[1] = -2 N/m or N m/rad: must be finite and >= 0");
    CHECK(message_of([&] { BatchLaw(Shared<double>{1}, Shared<double>{0}, Shared<double>{0}); }) ==
          "BatchLaw.limit = 0 m or rad: must be > 0 (infinity: no limit)");
    CHECK(message_of([&] { OneAxisBatch(BatchLaw(PerJoint<double>{good}), longer.arrays()); }) ==
          "BatchLaw.strength.size() = 3: must be 4, as motion.position.size()");
    CHECK(message_of([&] {
              OneAxisBatch(BatchLaw(Shared<double>{1}), memory.arrays(), {.drift_time = -1});
          }) == "OneAxisJoint.drift_time = -1 s: must be finite and > 0");
}
