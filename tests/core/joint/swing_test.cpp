// SPDX-License-Identifier: MIT
//
// A joint that swings, flows or rests, and the structure that it is in.
#include "ductile/joint/swing.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

#include "ductile/world/structures.hpp"

using namespace ductile;

namespace {

constexpr double dt = 1.0 / 100;

struct Joint final : StructureMember {
    SwingState<double> state;
    std::array<const void*, 2> bodies{};
    double damping = -1;
    bool held = false, broken = false;

    SwingState<double>* swing() noexcept override { return broken ? nullptr : &state; }
    [[nodiscard]] bool is_awake_member() const override { return true; }
    [[nodiscard]] std::array<const void*, 2> moving_bodies() const override { return bodies; }
    void damp(double time) noexcept override { damping = time; }
    void keep_awake() override { held = true; }
};

/// Three joints: two hang together by the body `shared`, the third is elsewhere.
struct Scene {
    int shared = 0, other = 0;
    std::array<Joint, 3> joints;
    Structures structures;

    Scene() {
        joints[0].bodies = {&shared, nullptr};
        joints[1].bodies = {nullptr, &shared};
        joints[2].bodies = {&other, nullptr};
        for (Joint& joint : joints) structures.add(joint);
    }
    void step(std::array<double, 3> used, int flows = -1) {
        for (int i = 0; i < 3; ++i) {
            joints[std::size_t(i)].held = false;
            joints[std::size_t(i)].state.step(used[std::size_t(i)], i == flows, dt);
        }
        structures.look();
    }
};

} // namespace

TEST_CASE("what flowed or came to a new peak within a second is not damped", "[joint][swing]") {
    Scene scene;
    const auto swing = [](int i) { return 0.5 * std::abs(std::sin(0.3 * i)); };
    for (int i = 0; i < 100; ++i) {
        scene.step({swing(i), 0.1, 0.2}, i == 60 ? 1 : -1);
        CHECK(scene.joints[0].damping == 0);
    }
    CHECK(scene.joints[2].damping == 0);
    for (int i = 100; i < 103; ++i) scene.step({swing(i), 0.1, 0.2});
    CHECK(scene.joints[2].damping > 0);
    CHECK(scene.joints[2].damping < 0.05 * 3 * dt); // or it would push harder than the swing
    for (int i = 103; i < 155; ++i) scene.step({swing(i), 0.1, 0.2});
    CHECK(scene.joints[0].damping == 0); // the other joint of its structure flowed
    CHECK(scene.joints[2].damping == Approx(0.05 * 0.54));
    for (int i = 155; i < 170; ++i) scene.step({swing(i), 0.1, 0.2});
    CHECK(scene.joints[0].damping == Approx(0.05 * 0.09));
    CHECK(scene.joints[1].damping == Approx(scene.joints[0].damping));
    scene.step({0.9, 0.1, 0.2}); // struck
    CHECK(scene.joints[0].damping == 0);
    CHECK(scene.joints[1].damping == 0);
    CHECK(scene.joints[2].damping > 0.03);
}

TEST_CASE("what is loaded slowly is not damped", "[joint][swing]") {
    for (const double seconds : {1.0, 10.0, 60.0}) {
        INFO("in " << seconds << " s");
        Scene scene;
        const int steps = int(seconds / dt);
        for (int i = 0; i < steps; ++i) {
            scene.step({double(i) / steps, 0.1, 0.2});
            CHECK(scene.joints[0].damping <= 0);
        }
    }
}

TEST_CASE("what is quiet is stirred by a load that comes over many steps", "[joint][swing]") {
    for (const double struck_before : {0.3, 0.9}) {
        Scene scene;
        scene.step({struck_before, 0, 0});
        for (int i = 0; i < 2500; ++i) {
            scene.step({0.3 + 0.02 * std::sin(0.3 * i) * std::exp(-0.01 * i), 0, 0});
        }
        REQUIRE(scene.joints[0].damping > 0);
        for (int i = 1; i <= 30; ++i) scene.step({0.3 + 0.005 * i, 0, 0});
        CHECK(scene.joints[0].damping == 0);
    }
}

TEST_CASE("a structure is kept awake until all of it has rested for a second", "[joint][swing]") {
    Scene scene;
    for (int i = 0; i < 250; ++i) scene.step({0.3, 0.5 * std::sin(0.3 * i), 0.3});
    CHECK(scene.joints[0].state.rests());
    CHECK(scene.joints[0].held); // with the one that swings
    CHECK_FALSE(scene.joints[2].held);
    for (int i = 0; i < 105; ++i) scene.step({0.3, 0.2, 0.3});
    CHECK_FALSE(scene.joints[0].held);
    scene.step({0.3, 0.2, 0.3}, 2);
    CHECK(scene.joints[2].held); // it flows, at a constant utilisation
}

TEST_CASE("who loses a joint of his structure is stirred", "[joint][swing]") {
    Scene scene;
    for (int i = 0; i < 250; ++i) scene.step({0.3, 0.2, 0.3});
    REQUIRE(scene.joints[0].damping > 0);
    scene.joints[1].broken = true;
    scene.structures.look();
    CHECK(scene.joints[0].damping == 0);
    CHECK(scene.joints[2].damping > 0);
    scene.structures.remove(scene.joints[1]);
    scene.structures.look();
}

TEST_CASE("what damping does not bring to rest is driven, and left alone", "[joint][swing]") {
    Scene scene;
    int i = 0;
    for (; i * dt < SwingState<double>::comes_to_rest + 1; ++i) {
        scene.step({0.3 + 0.1 * std::sin(0.3 * i), 0, 0});
    }
    CHECK(scene.joints[0].state.driven);
    CHECK(scene.joints[0].damping == 0);
    scene.structures.set_damping(0);
    scene.step({0.3, 0, 0});
    CHECK(scene.joints[2].damping == 0);
}

TEST_CASE("a joint without springs rests where it does not flow", "[joint][swing]") {
    SwingState<double> state;
    state.step(true, dt);
    CHECK_FALSE(state.rests());
    state.step(false, dt);
    CHECK(state.rests());
}
