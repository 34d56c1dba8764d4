// SPDX-License-Identifier: MIT
//
// Whom hands threw, or joined to something, since a frame left them; what a joint took in a blow.
#include "ductile/world/left_motions.hpp"

#include <catch2/catch.hpp>

#include "ductile/member/member_course.hpp"

using namespace ductile;

namespace {

const int a = 0, b = 0, c = 0;
const ContactBody still{}, flies{.velocity = {0, 3, 0}}, spins{.spin = {0, 0, 1e-12}};

} // namespace

TEST_CASE("a body was thrown where it moves, or is joined, other than it was left", "[member]") {
    LeftMotions left;
    CHECK(left.is_left(&a, still, 7)); // new, at rest
    CHECK_FALSE(left.is_left(&a, flies, 0));
    left.leave(&b, flies, joint_mark(&c, &a, &b));
    left.leave(&a, still, 0);
    CHECK(left.is_left(&a, still, 0));
    CHECK_FALSE(left.is_left(&a, spins, 0));
    CHECK(left.is_left(&b, flies, joint_mark(&c, &a, &b)));
    CHECK_FALSE(left.is_left(&b, still, joint_mark(&c, &a, &b)));
    CHECK_FALSE(left.is_left(&b, flies, joint_mark(&c, &b, &a)));
    CHECK_FALSE(left.is_left(&b, flies, 0));
    left.clear();
    CHECK_FALSE(left.is_left(&b, flies, joint_mark(&c, &a, &b)));
}

TEST_CASE("a joint takes what its bodies lose, and closes at the speed along its pull",
          "[member]") {
    // 2 kg at 3 m/s on what stands; its joint 0.5 m off its centre, I = 1 kg m²: a sphere about it
    constexpr double m = 2, v = 3, r = 0.5, inertia = 1;
    constexpr double pull = v / (1 / m + r * r / inertia);
    JointSide stands{.impulse = {0, pull, 0}};
    JointSide comes{.before = {.velocity = {0, v, 0}},
                    .after = {.velocity = {0, v - pull / m, 0}, .spin = {r * pull / inertia, 0, 0}},
                    .arm = {0, 0, r},
                    .impulse = {0, -pull, 0},
                    .moment = {r * pull, 0, 0}};
    CHECK(comes.after.at(comes.arm).y() == Approx(0).margin(1e-15));
    MemberStrike strike;
    strike.add(stands, comes, 4);
    CHECK(strike.energy == Approx(pull * v / 2));
    CHECK(strike.speed == Approx(v));
    CHECK(strike.segment == 4);
}
