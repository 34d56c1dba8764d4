// SPDX-License-Identifier: MIT
//
// The contract of an adapter, continued: a body whose numbers are not finite. Its joints say so,
// keep their states, and go on when it is put back as if nothing had been. Compiled for every
// engine and precision (RIG_HEADER), run with every solver.
#include RIG_HEADER

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "adapters/six_axis.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

constexpr double dt = 1.0 / 240;

/// A body that turns against its joint to the static world. `make(rig, body)` gives the joint.
template <class Make>
void spoil_and_go_on(const std::string& solver, Make make, bool at_start, double bad) {
    CAPTURE(solver, at_start, bad);
    struct Scene {
        Scene(const std::string& solver_of_rig, const Make& make_joint)
            : rig(solver_of_rig, none),
              body(rig.body(2, sphere(0.3), none, none, {0, 0, 20})),
              joint(&make_joint(rig, body)) {
            rig.set_iterations(60);
            for (int i = 0; i < 5; ++i) rig.step(dt);
        }
        Rig rig;
        typename Rig::Body body;
        std::remove_reference_t<decltype(make(std::declval<Rig&>(), body))>* joint;
    };
    Scene scene(solver, make), calm(solver, make);
    REQUIRE(scene.joint->outcome() == Outcome::yielding);
    const auto state = scene.joint->joint().state();
    const auto motion = Rig::motion(scene.body);
    // one that the engine meets as it starts, or makes of a force
    if (at_start) {
        Rig::set_spin(scene.body, {0, 0, bad});
    } else {
        Rig::apply_torque(scene.body, {0, 0, bad});
    }
    scene.rig.step(dt);
    CHECK(scene.joint->outcome() == Outcome::unreliable);
    CHECK(scene.joint->residual() == infinity);
    CHECK(scene.joint->joint().state() == state);
    CHECK(scene.joint->report().residual == infinity);

    scene.rig.put_back(scene.body, motion);
    for (int i = 0; i < 20; ++i) {
        scene.rig.step(dt);
        calm.rig.step(dt);
    }
    CHECK(scene.joint->outcome() == calm.joint->outcome());
    CHECK(scene.joint->plastic_travel() == Approx(calm.joint->plastic_travel()).epsilon(1e-6));
    CHECK(scene.joint->absorbed_energy() == Approx(calm.joint->absorbed_energy()).epsilon(1e-6));
}

} // namespace

TEST_CASE("joints of a body whose numbers are not finite say so and keep their states",
          "[contract][not_finite]") {
    for (const std::string& solver : Rig::solvers()) {
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity}) {
            for (const bool at_start : {true, false}) {
                const auto hinge = [](double stiffness) {
                    return [stiffness](Rig & rig, typename Rig::Body body) -> auto& {
                        return rig.hinge(body, nullptr, none, {0, 0, 1},
                                         one(40, infinity, stiffness));
                    };
                };
                spoil_and_go_on(solver, hinge(infinity), at_start, bad);
                spoil_and_go_on(solver, hinge(4e4), at_start, bad);
                spoil_and_go_on(
                    solver, [](Rig & rig, typename Rig::Body body) -> auto& {
                        return rig.six_axis(body, nullptr, Frame{}, six(V6::Constant(40)));
                    },
                    at_start, bad);
            }
        }
    }
}
