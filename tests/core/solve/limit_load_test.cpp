// SPDX-License-Identifier: MIT
//
// Redundant frames of rigid joints below, at and beyond their limit load, from scratch: forces
// there move along the surfaces of many joints at next to no cost.
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include "core/solve/islands.hpp"
#include "ductile/joint/elastic_row.hpp"
#include "ductile/material/named.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/solve/island_solver.hpp"
#include "ductile/structure/structure_plan.hpp"

using namespace ductile;
using namespace ductile::solve;

namespace {

/// Bays of 6 m, storeys of 3.5 m, of S355; one column hangs.
StructureModel frame(int bays, int storeys) {
    const ISection<double> heb200(
        {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015});
    const ISection<double> ipe300(
        {.width = 0.15, .height = 0.3, .web_thickness = 0.0071, .flange_thickness = 0.0107});
    const Material<double> steel(s355<double>());
    StructureModel model;
    std::vector<NodeId> below, above;
    for (int i = 0; i <= bays; ++i) {
        below.push_back(model.node({6.0 * i, 0, 0}));
        if (i != 1) model.support(below.back());
    }
    for (int k = 1; k <= storeys; ++k) {
        above.clear();
        for (int i = 0; i <= bays; ++i) {
            above.push_back(model.node({6.0 * i, 0, 3.5 * k}));
            model.member("column " + std::to_string(k) + std::to_string(i), below[std::size_t(i)],
                         above.back(), heb200, steel, {.joint_length = 0.2});
        }
        for (std::size_t i = 0; i < std::size_t(bays); ++i) {
            model.member("beam " + std::to_string(k) + std::to_string(i), above[i], above[i + 1],
                         ipe300, steel,
                         {.joint_length = 0.3, .carried_mass = 3000 + 500 * double(i)});
        }
        below = above;
    }
    return model;
}

/// A step of 1/60 s in which all that is not held would fall with `load` times g.
Island falling(const StructurePlan& plan, double load) {
    constexpr double dt = 1.0 / 60, time = 5 * dt;
    Island island;
    for (const PlanBody& body : plan.bodies) {
        const Matrix3<double> inverse = body.inertia.cwiseInverse().asDiagonal();
        island.bodies.push_back(island_body(Vector3<double>::Constant(1 / body.mass),
                                            body.pose.axes * inverse * body.pose.axes.transpose()));
    }
    for (const PlanJoint& joint : plan.joints) {
        const bool on_ground = joint.b.kind == PlanSeat::Kind::ground;
        IslandBlock block{.first = int(island.rows.size()), .count = 6};
        for (int i = 0; i < 6; ++i) {
            const Vector3<double> axis = joint.frame.axes.col(i % 3);
            const auto on = [&](std::size_t body) {
                const Vector3<double> arm = joint.frame.origin - plan.bodies[body].pose.origin;
                return i < 3 ? islands::push(arm, axis) : islands::turn(axis);
            };
            IslandRow& row = island.rows.emplace_back();
            row.a = int(joint.a);
            row.on_a = on(joint.a);
            if (!on_ground) {
                row.b = int(joint.b.index);
                row.on_b = -on(joint.b.index);
            } else if (i < 3) {
                row.target = 9.81 * load * dt * axis.z();
            }
            const double k = rigid_stiffness<double> * joint.joint.parameters().stiffness[i];
            row.softness = 1 / (k * time * dt);
            block.size[std::size_t(i)] = joint.joint.surface().semi_axes()[i] * dt;
        }
        island.blocks.push_back(block);
    }
    return island;
}

} // namespace

TEST_CASE("Frames are solved from scratch below, at and beyond their limit load", "[solve]") {
    for (const int bays : {2, 3}) {
        for (const int storeys : {1, 2, 3}) {
            const StructurePlan plan = make_plan(frame(bays, storeys));
            bool stood = false, fell = false;
            for (double load = 0.5; load < 8.5; load += 0.1) {
                CAPTURE(bays, storeys, load);
                Island island = falling(plan, load);
                IslandSolver solver;
                const IslandReport report = solver.solve(island);
                CHECK(report.solved);
                CHECK(report.residual <= 1e-6 * report.scale);
                CHECK(report.factorisations <= 100);
                double fastest = 0; // of what hangs, beside its fall
                const Vector3<double> fall(0, 0, -9.81 * load / 60);
                for (const IslandBody& body : island.bodies) {
                    fastest = std::max(fastest, (body.velocity.head<3>() + fall).norm());
                }
                (fastest < 1e-6 ? stood : fell) = true;
            }
            CHECK(stood);
            CHECK(fell);
        }
    }
}
