// SPDX-License-Identifier: MIT
//
// The return to a surface along paths with known answers.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "core/surface/cases.hpp"
#include "core/surface/closest_point_return.hpp"
#include "support/property.hpp"

using namespace ductile;
using namespace ductile::test;

namespace {

/// A table given with 7 digits.
constexpr double seven_digits = 5.1e-8;

/// M_p = 1000, T_p = 800 N m with the equal metric k_M/M_p² = k_T/T_p².
const BendingTorsion<double> ellipse({.plastic_moment = 1000, .plastic_torque = 800});
const Eigen::Matrix2d stiffness = Eigen::Vector2d(50e3, 32e3).asDiagonal();

enum class Kind { closest, radial };

/// m and t after bending to yield, then twisting by delta (normalised strain) in n increments.
Eigen::Vector2d twisted(double delta, int n, Kind kind) {
    Eigen::Vector2d force{1000, 0};
    const Eigen::Vector2d increment{0, delta / n * 800 / 32e3};
    for (int i = 0; i < n; ++i) {
        force = (kind == Kind::closest ? return_closest(ellipse, force, increment, stiffness)
                                       : return_radially(ellipse, force, increment, stiffness))
                    .force;
    }
    return {force[0] / 1000, force[1] / 800};
}

} // namespace

TEST_CASE("bent, then twisted: the return in N increments", "[surface]") {
    // Krieg & Krieg (1977): exact m = sech, t = tanh of the twist
    struct Row {
        double delta;
        std::vector<std::pair<int, double>> torque;
    };
    const std::vector<Row> table{
        {0.5, {{1, 0.4472136}, {2, 0.4526936}, {5, 0.4577993}, {10, 0.4598591}, {50, 0.4616491}}},
        {1.0, {{1, 0.7071068}, {2, 0.7270758}, {5, 0.7453692}, {10, 0.7530063}, {50, 0.759794}}},
        {2.0, {{1, 0.8944272}, {2, 0.9238795}, {5, 0.946258}, {10, 0.9548799}, {50, 0.9621628}}}};
    for (const auto& [delta, torques] : table) {
        for (const auto& [n, torque] : torques) {
            CAPTURE(delta, n);
            CHECK(std::abs(twisted(delta, n, Kind::radial)[1] - torque) <= seven_digits);
            // in the equal metric the closest point is the radial one
            CHECK(std::abs(twisted(delta, n, Kind::closest)[1] - torque) <= seven_digits);
        }
        double last = 0;
        for (const int n : {50, 100, 200, 400}) {
            const Eigen::Vector2d exact{1 / std::cosh(delta), std::tanh(delta)};
            const double error = (twisted(delta, n, Kind::closest) - exact).norm();
            if (last > 0) CHECK(std::log2(last / error) == Approx(1).margin(0.05)); // first order
            last = error;
        }
        CHECK(last < 1e-3);
    }
}

TEST_CASE("where the metric is not the ellipse's, the closest point is not the radial one",
          "[surface]") {
    const Eigen::Matrix2d soft = Eigen::Vector2d(50e3, 8e3).asDiagonal();
    const Eigen::Vector2d start{1000, 0};
    const Eigen::Vector2d increment{0.01, 0.05};
    const auto closest = return_closest(ellipse, start, increment, soft);
    const auto radial = return_radially(ellipse, start, increment, soft);
    // flow along the normal in one, not in the other
    const auto off_normal = [](const Return<Eigen::Vector2d>& r) {
        const Eigen::Vector2d normal = ellipse.normal(r.force).normalized();
        const Eigen::Vector2d flow = r.flow.normalized();
        return std::abs(normal[0] * flow[1] - normal[1] * flow[0]);
    };
    CHECK(off_normal(closest) < 1e-12);
    CHECK(off_normal(radial) > 0.1);
}

TEST_CASE("an increment is its elastic and its plastic part, and dissipates", "[surface]") {
    for_every_surface<double>([](const std::string& name, const auto& surface) {
        using T = std::decay_t<decltype(surface)>;
        using Vector = typename T::Vector;
        test::prop(name, [&] {
            const auto k = any_stiffness<typename T::Matrix>();
            Vector force = Vector::Zero(), total = force, plastic = force;
            for (int i = 0; i < 10; ++i) {
                const Vector increment = 2 * any_vector<Vector>();
                const auto next = return_closest(surface, force, increment, k);
                force = next.force;
                total += increment;
                plastic += next.flow;
                RC_ASSERT(next.force.dot(next.flow) >= -1e-12);
                RC_ASSERT(surface.value(force) <= 1 + on_surface<double>);
            }
            RC_ASSERT((force - k * (total - plastic)).norm() <= 1e-11);
        });
    });
}

TEST_CASE("a rectangle stretched while it bends: axial force by the neutral axis", "[surface]") {
    // long flow in a constant direction ends where the normal is that direction: n = Y/(h/2)
    const Scaled surface(RectangleAxialBending<double>(),
                         ScaledParameters<double, 2>{.capacity = {2.0, 0.5}}); // h = 4 M_p/N_p = 1
    const Eigen::Matrix2d k{{300.0, 40.0}, {40.0, 100.0}};
    Eigen::Vector2d force = Eigen::Vector2d::Zero();
    for (int i = 0; i < 400; ++i) {
        force = return_closest(surface, force, {0.15 * 0.002, 0.002}, k).force; // Y = 0.15
    }
    CHECK(force[0] / 2.0 == Approx(0.3).margin(1e-6));
    CHECK(force[1] / 0.5 == Approx(1 - 0.09).margin(1e-6));
}
