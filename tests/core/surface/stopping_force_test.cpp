// SPDX-License-Identifier: MIT
#include "ductile/surface/stopping_force.hpp"

#include <catch2/catch.hpp>

#include <Eigen/Core>

#include "core/surface/cases.hpp"
#include "core/surface/enforced_rows.hpp"

using namespace ductile;
using namespace ductile::test;

TEST_CASE("under a steady load the prediction is the answer, in rest and in flow", "[surface]") {
    const RectangleAxialBending<double> surface;
    for (const double size : {0.5, 1.5}) {
        CAPTURE(size);
        Rows<Exact, RectangleAxialBending<double>> rows{surface, masses};
        rows.velocity = {0.3, -0.2}; // so that the flow turns
        const Eigen::Vector2d load = size * Eigen::Vector2d(0.6, 0.5);
        const double dt = 1e-3;
        for (int i = 0; i < 20; ++i) {
            const Eigen::Vector2d predicted =
                predicted_force(surface, rows.force, rows.velocity, rows.last_velocity,
                                Eigen::Matrix2d(masses / dt));
            rows.step(load, dt);
            if (i > 0)
                CHECK((predicted - rows.force).norm() < 1e-12); // the load came before step 0
        }
    }
}
