// SPDX-License-Identifier: MIT
//
// Islands for tests of the solver, and the conditions of the answer written down once more, dense
// and from the definition, without a line of the solver.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "ductile/solve/island.hpp"
#include "ductile/surface/any_surface.hpp"
#include "ductile/surface/biaxial_rectangle.hpp"
#include "ductile/surface/i_axial_bending.hpp"
#include "ductile/surface/rectangle_axial_bending.hpp"
#include "ductile/surface/tube_axial_bending.hpp"

namespace islands {

using ductile::Matrix3;
using ductile::Vector3;
using ductile::Vector6;
using namespace ductile::solve;

inline IslandBody body(double mass, double gyration = 0.4) {
    return island_body(Vector3<double>::Constant(1 / mass),
                       Matrix3<double>::Identity() / (mass * gyration * gyration));
}

/// Jacobian of a force along `direction` at `arm` from the centre of mass.
inline Vector6<double> push(const Vector3<double>& arm, const Vector3<double>& direction) {
    return ductile::twist_of(direction, ductile::cross(arm, direction));
}
inline Vector6<double> turn(const Vector3<double>& about) {
    return ductile::twist_of<double>(Vector3<double>::Zero(), about);
}
inline Vector3<double> unit(int axis) {
    Vector3<double> result = Vector3<double>::Zero();
    result[axis] = 1;
    return result;
}

/// Six rows at a point: three forces, three moments. Returns the first.
inline int add_joint(Island& island, int a, int b, const Vector3<double>& arm_a,
                     const Vector3<double>& arm_b) {
    const int first = int(island.rows.size());
    for (int k = 0; k < 6; ++k) {
        IslandRow row;
        row.a = a;
        row.b = b;
        row.on_a = k < 3 ? push(arm_a, unit(k)) : turn(unit(k - 3));
        if (b >= 0) row.on_b = -(k < 3 ? push(arm_b, unit(k)) : turn(unit(k - 3)));
        island.rows.push_back(row);
    }
    return first;
}

/// A contact whose normal is z, with friction where `friction` > 0. Returns the normal row.
inline int add_contact(Island& island, int a, int b, const Vector3<double>& arm_a,
                       const Vector3<double>& arm_b, double friction) {
    const int first = int(island.rows.size());
    for (const int axis : {2, 0, 1}) {
        if (axis != 2 && !(friction > 0)) continue;
        IslandRow row;
        row.a = a;
        row.b = b;
        row.on_a = push(arm_a, unit(axis));
        if (b >= 0) row.on_b = -push(arm_b, unit(axis));
        row.softness = contact_softness * own_effect(island, row);
        if (axis == 2) row.lower = 0;
        island.rows.push_back(row);
    }
    if (friction > 0) {
        island.blocks.push_back({.kind = BlockKind::contact,
                                 .first = first,
                                 .count = 3,
                                 .size = {0, friction, friction}});
    }
    return first;
}

/// Surfaces that are no ellipsoids, in shares of their strengths: those of sections.
struct SectionSurfaces {
    ductile::RectangleAxialBending<double> rectangle;
    ductile::ThinTubeAxialBending<double> tube;
    ductile::IAxialBending<double> flanged{
        {.height = 0.2, .width = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015},
        ductile::BendingAxis::strong};
    ductile::BiaxialRectangle<double> biaxial;
    ductile::AnySurfaceOf<ductile::RectangleAxialBending<double>> any_rectangle{rectangle};
    ductile::AnySurfaceOf<ductile::ThinTubeAxialBending<double>> any_tube{tube};
    ductile::AnySurfaceOf<ductile::IAxialBending<double>> any_flanged{flanged};
    ductile::AnySurfaceOf<ductile::BiaxialRectangle<double>> any_biaxial{biaxial};

    [[nodiscard]] const ductile::AnySurface* at(int kind) const {
        const ductile::AnySurface* all[] = {&any_rectangle, &any_tube, &any_flanged, &any_biaxial};
        return all[kind];
    }
    /// Most work that the surface can do against `flow`, both in shares, from its closed form.
    [[nodiscard]] double dissipation(const ductile::AnySurface* surface,
                                     const Vector3<double>& flow) const {
        const Eigen::Vector2d two = flow.head<2>();
        if (surface == &any_rectangle) return rectangle.support(two).dot(two);
        if (surface == &any_tube) return tube.support(two).dot(two);
        if (surface == &any_flanged) return flanged.support(two).dot(two);
        return biaxial.support(flow).dot(flow);
    }
};
inline const SectionSurfaces& section_surfaces() {
    static const SectionSurfaces surfaces;
    return surfaces;
}

/// Chains with loops of six-axis joints on ellipsoids, and boxed and one-sided rows between.
struct Random {
    std::mt19937 random;
    double compliance = 1e-6; ///< of a row's own effect
    double strength = 1;      ///< [N s]
    bool sections = false;    ///< two or three rows of a joint share a section's surface

    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random); }
    double normal() { return std::normal_distribution<double>()(random); }
    Vector3<double> point() { return {normal() / 2, normal() / 2, normal() / 2}; }
    double decades(double from, double to) {
        return std::pow(10.0, from + (to - from) * uniform());
    }

    Island island(int bodies, bool surfaces, bool friction = false) {
        Island result;
        for (int i = 0; i < bodies; ++i)
            result.bodies.push_back(body(decades(0, 2), 0.2 + uniform()));
        const double speed = decades(-1, 1);
        const auto link = [&](int a, int b) {
            const int first = add_joint(result, a, b, point(), point());
            IslandBlock block{.first = first, .count = 6};
            for (int k = 0; k < 6; ++k) {
                IslandRow& row = result.rows[std::size_t(first + k)];
                row.target = speed * normal();
                const double cap = strength * decades(-1, 1);
                block.size[std::size_t(k)] = cap;
                if (!surfaces) row.lower = -(row.upper = cap);
            }
            if (surfaces && sections) {
                const int kind = int(4 * uniform());
                block.kind = BlockKind::surface;
                block.surface = section_surfaces().at(kind);
                block.count = kind < 3 ? 2 : 3;
                for (int k = block.count; k < 6; ++k) {
                    IslandRow& row = result.rows[std::size_t(first + k)];
                    row.lower = -(row.upper = block.size[std::size_t(k)]);
                }
            }
            if (surfaces) result.blocks.push_back(block);
        };
        link(0, immovable);
        for (int i = 1; i < bodies; ++i) link(i, i - 1);
        for (int i = 0; i < int(uniform() * bodies); ++i) {
            const int a = int(uniform() * bodies), b = int(uniform() * bodies);
            if (a != b) link(a, b);
        }
        for (int i = 0; i < bodies; ++i) {
            const int a = int(uniform() * bodies), b = int(uniform() * (bodies + 1)) - 1;
            if (a == b) continue;
            const int first = add_contact(result, a, b, point(), point(), friction ? 0.5 : 0);
            for (std::size_t k = std::size_t(first); k < result.rows.size(); ++k) {
                result.rows[k].target = speed * normal();
            }
        }
        for (IslandRow& row : result.rows) {
            row.compliance = std::max(row.softness, compliance * own_effect(result, row));
        }
        for (const IslandBlock& block : result.blocks) { // one compliance for all friction
            if (block.kind != BlockKind::contact) continue;
            IslandRow& t1 = result.rows[std::size_t(block.first + 1)];
            IslandRow& t2 = result.rows[std::size_t(block.first + 2)];
            t1.compliance = t2.compliance = std::max(t1.compliance, t2.compliance);
        }
        return result;
    }
};

/// Bodies at the points of a grid, each joined to the next ones on ellipsoids of six axes, rigid
/// but for `softness` of a row's own effect [-]; three of them are struck. The semi-axes are some
/// `strength` [N s] and a tenth of it [N m s].
inline Island struck_grid(std::mt19937& random, int nx, int ny, int nz, double strength,
                          double softness) {
    constexpr double speed = 5;
    const auto between = [&random](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    Island result;
    std::vector<Vector3<double>> moved;
    for (int i = 0; i < nx * ny * nz; ++i) {
        result.bodies.push_back(body(between(1, 10), 0.3));
        moved.emplace_back(0, 0, 0);
    }
    for (int i = 0; i < 3; ++i) {
        const auto struck = std::size_t(between(0, double(moved.size())));
        moved[struck] = {between(-speed, speed), between(-speed, speed), between(-speed, speed)};
    }
    const auto link = [&](int a, int b, int axis) {
        const int first = add_joint(result, a, b, unit(axis) / 2, unit(axis) / -2);
        IslandBlock block{.first = first, .count = 6};
        for (int k = 0; k < 6; ++k) {
            IslandRow& row = result.rows[std::size_t(first + k)];
            row.softness = softness * own_effect(result, row) * between(0.1, 1.1);
            row.target = -row.on_a.head<3>().dot(moved[std::size_t(a)]) -
                         row.on_b.head<3>().dot(moved[std::size_t(b)]);
            block.size[std::size_t(k)] = strength * (k < 3 ? 1 : 0.1) * between(0.5, 1.5);
        }
        result.blocks.push_back(block);
    };
    const auto number = [nx, ny](int i, int j, int k) { return (k * ny + j) * nx + i; };
    for (int k = 0; k < nz; ++k) {
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                const int here = number(i, j, k);
                if (i + 1 < nx) link(here, number(i + 1, j, k), 0);
                if (j + 1 < ny) link(here, number(i, j + 1, k), 1);
                if (k + 1 < nz) link(here, number(i, j, k + 1), 2);
            }
        }
    }
    return result;
}

/// Boxes that stand on four corners each, `stack` of them on each of `beams` beams in a row that
/// joints hold, struck in all directions: a step of 1/60 s.
inline Island stacked_boxes(std::mt19937& random, int beams, int stack) {
    constexpr double dt = 1.0 / 60, gravity = 9.81;
    const auto between = [&random](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    Island result;
    std::vector<Vector3<double>> speed;
    const double friction = between(0.1, 1.2);
    for (int i = 0; i < beams; ++i) {
        result.bodies.push_back(body(between(50, 200)));
        speed.emplace_back(between(-0.01, 0.01), between(-0.01, 0.01), between(-0.01, 0.01));
        const int first = add_joint(result, i, i - 1, {-0.5, 0, 0}, {0.5, 0, 0});
        for (int k = 0; k < 6; ++k) {
            result.rows[std::size_t(first + k)].compliance =
                (k < 3 ? 1e-9 : 1e-7) / (dt * dt) * between(0.1, 1);
        }
    }
    for (int i = 0; i < beams; ++i) {
        for (int k = 0, below = i; k < stack; ++k) {
            const int box = int(result.bodies.size());
            result.bodies.push_back(body(between(20, 500)));
            speed.emplace_back(between(-2, 2), between(-2, 2), between(-1, 0.1));
            for (const double x : {-0.3, 0.3}) {
                for (const double y : {-0.3, 0.3}) {
                    add_contact(result, box, below, {x, y, -0.3}, {x, y, k == 0 ? 0.1 : 0.3},
                                friction);
                }
            }
            below = box;
        }
    }
    for (IslandRow& row : result.rows) {
        const auto closing = [&](int which, const Vector6<double>& on) {
            if (which < 0) return 0.0;
            const Vector3<double>& v = speed[std::size_t(which)];
            return on[0] * v[0] + on[1] * v[1] + on[2] * (v[2] - gravity * dt);
        };
        row.target = -closing(row.a, row.on_a) - closing(row.b, row.on_b);
    }
    return result;
}

/// J M⁻¹ Jᵀ + C of all rows.
inline Eigen::MatrixXd system_matrix(const Island& island) {
    const auto n = Eigen::Index(island.rows.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    const auto entry = [&](const IslandRow& p, const IslandRow& q, int body) {
        const Vector6<double> zero = Vector6<double>::Zero();
        const Vector6<double>& left = p.a == body ? p.on_a : p.b == body ? p.on_b : zero;
        const Vector6<double>& right = q.a == body ? q.on_a : q.b == body ? q.on_b : zero;
        return left.dot(moved(island.bodies[std::size_t(body)], right));
    };
    for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < n; ++j) {
            for (int body = 0; body < int(island.bodies.size()); ++body) {
                a(i, j) += entry(island.rows[std::size_t(i)], island.rows[std::size_t(j)], body);
            }
        }
        a(i, i) += island.rows[std::size_t(i)].compliance;
    }
    return a;
}
inline Eigen::VectorXd impulses(const Island& island) {
    Eigen::VectorXd x(Eigen::Index(island.rows.size()));
    for (std::size_t i = 0; i < island.rows.size(); ++i)
        x[Eigen::Index(i)] = island.rows[i].impulse;
    return x;
}
inline Eigen::VectorXd targets(const Island& island) {
    Eigen::VectorXd b(Eigen::Index(island.rows.size()));
    for (std::size_t i = 0; i < island.rows.size(); ++i) b[Eigen::Index(i)] = island.rows[i].target;
    return b;
}

/// Worst violation of the definition in island.hpp, as a velocity: rows by their sign, blocks by
/// the maximum of dissipation, -w·y <= -w·x for every y of the block.
inline double violation(const Island& island, const Eigen::MatrixXd& a) {
    const Eigen::VectorXd x = impulses(island), w = a * x - targets(island);
    std::vector<bool> in_block(island.rows.size(), false);
    double worst = 0;
    for (const IslandBlock& block : island.blocks) {
        const bool contact = block.kind == BlockKind::contact;
        const double normal = contact ? x[block.first] : 1;
        Vector6<double> share = Vector6<double>::Zero();
        Vector3<double> flow = Vector3<double>::Zero(); // of a surface, in shares [J]
        double gauge = 0, met = 0, most = 0, largest = 0;
        if (contact) { // w_n >= 0, n >= 0, one of them zero
            const double w_normal = w[block.first], effect = a(block.first, block.first);
            worst = std::max({worst, -normal * effect, -w_normal});
            if (normal > 1e-9 / effect) worst = std::max(worst, w_normal);
        }
        for (int i = 0; i < block.count; ++i) {
            const auto at = Eigen::Index(block.first + i);
            in_block[std::size_t(at)] = true;
            if (contact && i == 0) continue;
            const double cap = block.size[std::size_t(i)] * std::max(0.0, normal);
            if (cap > 0) gauge += std::pow(x[at] / cap, 2);
            if (!(cap > 0)) worst = std::max(worst, std::abs(x[at]) * a(at, at));
            met -= w[at] * x[at];
            if (block.surface != nullptr) {
                share[i] = x[at] / cap;
                flow[i] = -w[at] * cap;
            }
            most += std::pow(w[at] * cap, 2);
            largest = std::max(largest, cap);
        }
        if (!(largest > 0)) continue;
        const auto first = Eigen::Index(block.first);
        if (block.surface != nullptr) {
            gauge = std::pow(block.surface->value(share), 2);
            most = std::pow(section_surfaces().dissipation(block.surface, flow), 2);
        }
        worst = std::max(worst, (std::sqrt(gauge) - 1) * largest * a(first, first));
        // dissipation that was missed, as a velocity
        worst = std::max(worst, (std::sqrt(most) - met) / largest);
    }
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
        if (in_block[i]) continue;
        const auto k = Eigen::Index(i);
        const IslandRow& row = island.rows[i];
        const double slack = 1e-9 / a(k, k);
        worst = std::max({worst, (row.lower - x[k]) * a(k, k), (x[k] - row.upper) * a(k, k)});
        if (x[k] < row.upper - slack) worst = std::max(worst, -w[k]);
        if (x[k] > row.lower + slack) worst = std::max(worst, w[k]);
    }
    return worst;
}

/// 1/2 xᵀ A x - bᵀ x [J].
inline double energy(const Island& island, const Eigen::MatrixXd& a) {
    const Eigen::VectorXd x = impulses(island);
    return x.dot(a * x) / 2 - targets(island).dot(x);
}

} // namespace islands
