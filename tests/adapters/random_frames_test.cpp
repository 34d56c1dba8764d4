// SPDX-License-Identifier: MIT
//
// P43: random frames stand below their limit load, and fall above it, in a World as it comes. The
// limit loads are those of tests/reference/limit_load.py, by the static and the kinematic theorem:
//
//   structures_bullet_double "[.statics]" | tests/reference/limit_load.py
#include RIG_HEADER

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

#include "adapters/random_frames.hpp"
#include "ductile/structure/structure_plan.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

/// On the last member that is level, at 0.4 of it [m].
Vector3<double> on_last_beam(const StructurePlan& plan) {
    const PlanMember* beam = nullptr;
    for (const PlanMember& member : plan.members) {
        if (std::abs(member.from.z() - member.to.z()) < 1e-9) beam = &member;
    }
    return beam->from + 0.4 * (beam->to - beam->from);
}

} // namespace

TEST_CASE("P43 random frames stand below their limit load and fall above it", "[structures]") {
    if (StructureRig::single) return; // the margin is round-off's
    constexpr double dt = 1.0 / 60;
    for (const LimitLoad& limit : limit_loads) {
        double beyond = 0;
        for (const double share : {1.002, 0.998}) {
            CAPTURE(limit.seed, limit.factor, share);
            StructureRig rig;
            const auto frame = rig.build(RandomFrame(limit.seed, false).model());
            rig.keep_awake();
            for (int i = 1; i <= 60; ++i) {
                frame->scale_weights(limit.factor * share * i / 60);
                rig.step(dt);
            }
            double fastest = 0; // it may come to hang from its beams, and stop
            for (int i = 0; i < 60; ++i) {
                rig.step(dt);
                fastest = std::max(fastest, rig.speed());
            }
            const double work = frame->absorbed_energy();
            if (share > 1) {
                beyond = work;
                CHECK(fastest > 5e-3);
            } else {
                CHECK(rig.speed() < 1e-6);
                CHECK(work < 1e-3 * beyond); // as loads are shared out anew
                rig.run(4, dt);
                CHECK(frame->absorbed_energy() < 1e-3 * beyond);
                for (const std::string& line : rig.lines()) {
                    CHECK(line.find("unsolved") == std::string::npos);
                }
            }
            rig.forget();
        }
    }
}

TEST_CASE("what elastic frames absorb of weight that comes at once hardly depends on the frame",
          "[structures]") {
    if (StructureRig::single) return; // as above
    const auto work = [](std::uint32_t seed, double dt) {
        engine::WorldParameters parameters;
        parameters.tolerance = 0.01;
        StructureRig rig(9.81, parameters);
        const auto frame = rig.build(RandomFrame(seed, true).model());
        rig.run(0.35, dt);
        const double absorbed = frame->absorbed_energy();
        rig.forget();
        return absorbed;
    };
    int yielded = 0;
    for (std::uint32_t seed = 0; seed < 24; ++seed) {
        const double fine = work(seed, 1.0 / 960);
        CAPTURE(seed, fine);
        if (fine == 0) {
            CHECK(work(seed, 1.0 / 60) == 0);
            continue;
        }
        if (fine < 50) continue; // the tip of a swing
        ++yielded;
        CHECK(work(seed, 1.0 / 240) == Approx(fine).epsilon(0.03));
        // a swing of which a frame is a good part is off by some of it at its tip, unsaid
        CHECK(work(seed, 1.0 / 60) == Approx(fine).epsilon(fine < 500 ? 0.1 : 0.02));
    }
    CHECK(yielded == 9);
}

TEST_CASE("what an elastic frame at rest absorbs of a blow hardly depends on the frame's length",
          "[structures]") {
    if (StructureRig::single) return; // as above
    const auto work = [](std::uint32_t seed, double tolerance, double dt) {
        engine::WorldParameters parameters;
        parameters.tolerance = tolerance;
        StructureRig rig(0, parameters);
        const auto frame = rig.build(RandomFrame(seed, true, true).model());
        const Vector3<double> hit = on_last_beam(frame->plan());
        const auto box = rig.box(1200, {0.2, 0.2, 0.2}, hit + Vector3<double>(0, 0, 0.6));
        StructureRig::set_velocity(box, {0, 0, -5});
        rig.run(0.35, dt);
        CHECK(rig.world().run().believed());
        const double absorbed = frame->absorbed_energy();
        rig.forget();
        return absorbed;
    };
    for (const std::uint32_t seed : {0u, 13u, 14u, 22u}) {
        const double fine = work(seed, 0.002, 1.0 / 240);
        CAPTURE(seed, fine);
        CHECK(work(seed, 0.01, 1.0 / 60) == Approx(fine).epsilon(0.06)); // seed 13 was 15 % off
        CHECK(work(seed, 0.01, 1.0 / 240) == Approx(fine).epsilon(0.06));
    }
}

TEST_CASE("what a box brings in that lay in a frame of many joints is told", "[structures]") {
    if (StructureRig::single) return; // as above
    // 1 t that overlaps a beam by 10 to 20 cm, pushed out with 1.3 to 3.4 kJ, beside 0.1 kJ of flow
    for (const auto& [seed, above] :
         {std::pair(0u, 0.2), std::pair(20u, 0.1), std::pair(23u, 0.2)}) {
        engine::WorldParameters parameters;
        parameters.tolerance = 0.01;
        parameters.ledger = true;
        StructureRig rig(9.81, parameters);
        const auto frame = rig.build(RandomFrame(seed, true, true).model());
        rig.box(1000, {0.2, 0.2, 0.2}, on_last_beam(frame->plan()) + Vector3<double>(0, 0, above));
        rig.run(0.5, 1.0 / 60);
        CAPTURE(seed, frame->absorbed_energy());
        CHECK(rig.world().run().brought_in > 500);
        CHECK_FALSE(rig.world().run().believed());
        rig.forget();
    }
}

TEST_CASE("the statics of random frames, for limit_load.py", "[.statics]") {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        const StructurePlan plan = make_plan(RandomFrame(seed, true).model());
        std::printf("{\"seed\": %u, \"bodies\": [", unsigned(seed));
        for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
            const PlanBody& body = plan.bodies[i];
            const Vector3<double>& at = body.pose.origin;
            std::printf("%s[%.17g, %.17g, %.17g, %.17g]", i > 0 ? ", " : "", body.mass, at.x(),
                        at.y(), at.z());
        }
        std::printf("], \"joints\": [");
        for (std::size_t i = 0; i < plan.joints.size(); ++i) {
            const PlanJoint& joint = plan.joints[i];
            const bool on_ground = joint.b.kind == PlanSeat::Kind::ground;
            std::printf("%s{\"a\": %d, \"b\": %d, \"numbers\": [", i > 0 ? ", " : "", int(joint.a),
                        on_ground ? -1 : int(joint.b.index));
            // place, axes by columns, capacity, stiffness
            for (int k = 0; k < 3; ++k) std::printf("%.17g, ", joint.frame.origin[k]);
            for (int k = 0; k < 9; ++k) std::printf("%.17g, ", joint.frame.axes(k % 3, k / 3));
            for (int k = 0; k < 6; ++k) {
                std::printf("%.17g, ", joint.joint.surface().semi_axes()[k]);
            }
            for (int k = 0; k < 6; ++k) {
                std::printf("%.17g%s", joint.joint.parameters().stiffness[k], k < 5 ? ", " : "]}");
            }
        }
        std::printf("]}\n");
    }
}
