// SPDX-License-Identifier: MIT
//
// A joint that turns with its bodies, loaded below yield: what it holds is no flow. The velocity of
// a row changes with the axes it is seen along, which nobody has kicked.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <utility>

#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/link.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"
#include "reference/pair_world.hpp"
#include "support/axes_along.hpp"

using namespace ductile;
using ductile::reference::PairWorld;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;
using Body = BodyState<double>;

/// 3 kg half a metre out on a hub that goes on at 2 rad/s about z: 6 N towards it.
template <class Joint, class Axes>
void holds(Joint joint, const Axes& axes) {
    const double dt = GENERATE(1.0 / 60, 1.0 / 240), rate = 2;
    const V3 out(0.5, 0, 0);
    Body arm{.position = out, .inverse_mass = 1.0 / 3, .inverse_inertia = M3::Identity() / 0.2};
    Body hub{.inverse_mass = 1e-9, .inverse_inertia = 1e-9 * M3::Identity()};
    arm.spin = hub.spin = V3(0, 0, rate);
    arm.velocity = hub.spin.cross(out);
    // frames with z, the member's, along the arm
    const M3 along = test::axes_along(out);
    PairWorld world(arm, hub,
                    Link(std::move(joint), axes, {V3(-out / 2), along}, {V3(out / 2), along}));
    for (int i = 0; i < 200; ++i) world.step(dt, V3::Zero(), V3::Zero(), 0.2 / dt);
    INFO("dt = " << dt);
    const auto& state = world.link().joint().state();
    CHECK(state.plastic_work == 0);
    CHECK(state.plastic_travel == 0);
    CHECK(world.link().outcome() == Outcome::elastic);
    // the arm's lag stretches it by (ω dt)²/2 a step, of which a fifth is taken back in each
    const double lag = std::pow(rate * dt, 2) / (2 * 0.2);
    CHECK(world.link().force(JointAxis::axial) == Approx(-6).epsilon(1e-4 + 2 * lag));
}

} // namespace

TEST_CASE("a joint that turns on below its strength consumes no life", "[joint][link]") {
    const Perfect<double> law({.strength = 1e4});
    SECTION("six coupled axes") {
        holds(CoupledJoint(Ellipsoid<double, 6>({.capacity = Vector6<double>::Constant(1e4)}), law),
              all_joint_axes);
    }
    SECTION("one axis, along the arm") { holds(OneAxisJoint(law), std::array{JointAxis::axial}); }
}
