// SPDX-License-Identifier: MIT
//
// Bodies of forest_solver.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ductile/solve/forest_solver.hpp"

namespace ductile::solve {

DUCTILE_INLINE bool ForestSolver::serves(const Island& island) noexcept {
    const std::size_t rows = island.rows.size();
    return rows % axes == 0 && rows >= 2 * axes && rows <= axes * island.bodies.size() &&
           std::all_of(island.blocks.begin(), island.blocks.end(), [](const IslandBlock& block) {
               return block.kind == BlockKind::ellipsoid && block.state == BlockState::inside;
           });
}

/// Six rows after each other between the same two bodies are a joint.
DUCTILE_INLINE bool ForestSolver::read() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const IslandBody& body : island_->bodies) { // a locked axis: the general way leaves it
        for (int i = 0; i < 3; ++i) {
            if (!(body.inverse_mass[i] > 0 && body.inverse_inertia(i, i) > 0)) return false;
        }
    }
    scale_ = 0;
    joints_.resize(island_->rows.size() / axes);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        Joint& joint = joints_[j];
        joint.rows = &island_->rows[j * axes];
        for (int i = 0; i < axes; ++i) {
            const IslandRow& row = joint.rows[i];
            if (row.a != joint.rows[0].a || row.b != joint.rows[0].b) return false;
            const double own = row.compliance > 0 ? own_effect(*island_, row) : 1;
            joint.share[i] = row.compliance > 0 ? own / (own + row.compliance) : 1;
            const double asked = opens(row) ? 0 : joint.share[i] * std::abs(row.target);
            scale_ = std::max(scale_, asked);
            joint.lower[i] = row.lower;
            joint.upper[i] = row.upper;
            joint.side[std::size_t(i)] = row.side;
        }
    }
    for (const IslandBlock& block : island_->blocks) { // its rows have no bounds of their own
        for (int k = block.first; k < block.first + block.count; ++k) {
            Joint& joint = joints_[std::size_t(k / axes)];
            joint.lower[k % axes] = -infinity;
            joint.upper[k % axes] = infinity;
        }
    }
    for (Joint& joint : joints_) {
        for (int i = 0; i < axes; ++i) {
            Side& side = joint.side[std::size_t(i)];
            if (!(joint.lower[i] < joint.upper[i])) side = Side::lower;
            if (!std::isfinite(joint.bound(i))) side = Side::free;
            joint.x[i] = side == Side::free ? 0 : joint.bound(i);
        }
    }
    return find_order();
}

/// Those of each body after each other.
DUCTILE_INLINE void ForestSolver::list_joints() {
    nodes_.resize(island_->bodies.size());
    for (Node& node : nodes_) {
        node.joint = node.root = none;
        node.bears = node.found = false;
        node.first = 0;
    }
    const auto each = [this](const auto& call) {
        for (std::size_t j = 0; j < joints_.size(); ++j) {
            const IslandRow& row = joints_[j].rows[0];
            if (row.a >= 0) call(nodes_[std::size_t(row.a)], int(j));
            if (row.b >= 0) call(nodes_[std::size_t(row.b)], int(j));
        }
    };
    each([](Node& node, int) { ++node.first; });
    int end = 0;
    for (Node& node : nodes_) node.first = end += node.first;
    of_bodies_.resize(std::size_t(end));
    each([this](Node& node, int j) { of_bodies_[std::size_t(--node.first)] = j; });
}

/// A body is found over its joint; false where it was found before.
DUCTILE_INLINE bool ForestSolver::add(int body, int joint, int root) {
    Node& node = nodes_[std::size_t(body)];
    if (std::exchange(node.found, true)) return false;
    node.joint = joint;
    node.root = root;
    if (joint != none) {
        Joint& its = joints_[std::size_t(joint)];
        its.turned = its.rows[0].a != body;
    }
    if (root != none) nodes_[std::size_t(root)].bears = true;
    order_.push_back(body);
    return true;
}

/// Bodies from the ground on, or from the first of those that are free. False where there is a
/// loop.
DUCTILE_INLINE bool ForestSolver::find_order() {
    list_joints();
    order_.clear();
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const IslandRow& row = joints_[j].rows[0];
        if (row.a >= 0 && row.b >= 0) continue;
        const int body = std::max(row.a, row.b);
        if (body < 0 || !add(body, int(j), none)) return false;
    }
    std::size_t joints = order_.size();
    int next = 0; // where those may begin that are not on the ground
    for (std::size_t at = 0; at < nodes_.size(); ++at) {
        while (at == order_.size()) {
            (void)add(next, none, none);
            ++next;
        }
        const int body = order_[at];
        const Node& node = nodes_[std::size_t(body)];
        const int end = std::size_t(body) + 1 < nodes_.size() ? nodes_[std::size_t(body) + 1].first
                                                              : int(of_bodies_.size());
        for (int k = node.first; k < end; ++k) {
            const int j = of_bodies_[std::size_t(k)];
            const IslandRow& row = joints_[std::size_t(j)].rows[0];
            if (row.a < 0 || row.b < 0 || j == node.joint) continue;
            if (!add(row.a == body ? row.b : row.a, j, body)) return false;
            ++joints;
        }
    }
    return joints == joints_.size();
}

/// What its joint feels of a body and of all beyond it, and the body before it of that.
DUCTILE_INLINE bool ForestSolver::take_out(int body) noexcept {
    Node& node = nodes_[std::size_t(body)];
    const IslandBody& its = island_->bodies[std::size_t(body)];
    if (node.bears) {
        node.factors = numeric::Cholesky<double, axes>(node.mass);
        if (!node.factors.succeeded()) return false;
    }
    if (node.joint == none) return true;
    Joint& joint = joints_[std::size_t(node.joint)];
    Matrix6<double> s;
    Vector6<double> asked;
    for (int i = 0; i < axes; ++i) asked[i] = joint.rows[i].target;
    if (node.bears) {
        std::array<Vector6<double>, axes> through; // rows of L⁻¹ J_cᵀ
        for (int i = 0; i < axes; ++i) {
            for (int k = 0; k < axes; ++k) through[std::size_t(i)][k] = joint.beyond(k)[i];
        }
        Vector6<double> push = node.push;
        s.setZero();
        for (int i = 0; i < axes; ++i) {
            Vector6<double>& row = through[std::size_t(i)];
            for (int j = 0; j < i; ++j) {
                row -= node.factors.below(i, j) * through[std::size_t(j)];
                push[i] -= node.factors.below(i, j) * push[j];
            }
            const double share = node.factors.inverse_pivot(i);
            for (int k = 0; k < axes; ++k) s.col(k) += (share * row[k]) * row;
            asked -= (share * push[i]) * row;
        }
    } else {
        for (int k = 0; k < axes; ++k) {
            const Vector6<double> velocity = moved(its, joint.beyond(k));
            for (int i = k; i < axes; ++i) s(i, k) = joint.beyond(i).dot(velocity);
        }
    }
    Vector6<double> fixed = Vector6<double>::Zero(); // on the body before it
    for (int i = 0; i < axes; ++i) s(i, i) += joint.rows[i].compliance;
    for (int i = 0; i < axes; ++i) {
        if (joint.holds(i)) continue;
        for (int k = 0; k < axes; ++k) {
            asked[k] -= (k < i ? s(i, k) : s(k, i)) * joint.x[i];
        }
        fixed += joint.x[i] * joint.before(i);
    }
    for (int i = 0; i < axes; ++i) {
        if (joint.holds(i)) continue;
        for (int k = 0; k < axes; ++k) s(std::max(i, k), std::min(i, k)) = i == k ? 1 : 0;
        asked[i] = joint.x[i];
    }
    joint.factors = numeric::Cholesky<double, axes>(s);
    if (!joint.factors.succeeded()) return false;
    joint.asked = asked;
    for (int i = 0; i < axes; ++i) {
        for (int j = 0; j < i; ++j) joint.asked[i] -= joint.factors.below(i, j) * joint.asked[j];
    }
    if (node.root == none) return true;
    Node& before = nodes_[std::size_t(node.root)];
    before.push += fixed;
    for (int i = 0; i < axes; ++i) {
        Vector6<double>& row = joint.towards[std::size_t(i)];
        if (joint.holds(i)) {
            row = joint.before(i);
        } else {
            row.setZero();
        }
        for (int j = 0; j < i; ++j) {
            row -= joint.factors.below(i, j) * joint.towards[std::size_t(j)];
        }
        const double share = joint.factors.inverse_pivot(i);
        for (int k = 0; k < axes; ++k) before.mass.col(k) += (share * row[k]) * row;
        before.push += (share * joint.asked[i]) * row;
    }
    return true;
}

/// Its joint's impulses, and its velocity, where the body before it has its own.
DUCTILE_INLINE void ForestSolver::put_in(int body) noexcept {
    Node& node = nodes_[std::size_t(body)];
    IslandBody& its = island_->bodies[std::size_t(body)];
    Vector6<double> push = node.push;
    if (node.joint != none) {
        Joint& joint = joints_[std::size_t(node.joint)];
        joint.x = joint.asked;
        if (node.root != none) {
            const Vector6<double>& velocity = island_->bodies[std::size_t(node.root)].velocity;
            for (int i = 0; i < axes; ++i) {
                joint.x[i] -= joint.towards[std::size_t(i)].dot(velocity);
            }
        }
        for (int i = axes - 1; i >= 0; --i) {
            joint.x[i] *= joint.factors.inverse_pivot(i);
            for (int k = i + 1; k < axes; ++k) joint.x[i] -= joint.factors.below(k, i) * joint.x[k];
        }
        if (!node.bears) return;
        for (int i = 0; i < axes; ++i) push += joint.x[i] * joint.beyond(i);
    }
    its.velocity = node.bears ? node.factors.solve(push) : moved(its, push);
}

DUCTILE_INLINE bool ForestSolver::solve_once() noexcept {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_[i].push.setZero();
        if (nodes_[i].bears) nodes_[i].mass = mass(island_->bodies[i]);
    }
    for (std::size_t at = order_.size(); at-- > 0;) {
        if (!take_out(order_[at])) return false;
    }
    for (const int body : order_) put_in(body);
    update_velocities();
    return true;
}

/// Those of the impulses.
DUCTILE_INLINE void ForestSolver::update_velocities() noexcept {
    std::vector<IslandBody>& bodies = island_->bodies;
    for (IslandBody& body : bodies) body.velocity.setZero();
    for (const Joint& joint : joints_) {
        const int a = joint.rows[0].a, b = joint.rows[0].b;
        for (int i = 0; i < axes; ++i) {
            if (a >= 0) bodies[std::size_t(a)].velocity += joint.x[i] * joint.rows[i].on_a;
            if (b >= 0) bodies[std::size_t(b)].velocity += joint.x[i] * joint.rows[i].on_b;
        }
    }
    for (IslandBody& body : bodies) {
        const Vector6<double> impulse = body.velocity;
        body.velocity = moved(body, impulse);
    }
}

/// b - J v - C x
DUCTILE_INLINE double ForestSolver::left(const IslandRow& row, double x) const noexcept {
    double result = row.target - row.compliance * x;
    if (row.a >= 0) result -= row.on_a.dot(island_->bodies[std::size_t(row.a)].velocity);
    if (row.b >= 0) result -= row.on_b.dot(island_->bodies[std::size_t(row.b)].velocity);
    return result;
}

/// How many rows did.
DUCTILE_INLINE int ForestSolver::change_over() noexcept {
    constexpr double round_off = 1e-13;
    int wrong = 0;
    for (Joint& joint : joints_) {
        for (int i = 0; i < axes; ++i) {
            if (!(joint.lower[i] < joint.upper[i])) continue;
            Side& side = joint.side[std::size_t(i)];
            double& x = joint.x[i];
            Side to = side;
            if (side == Side::free) {
                const double slack = round_off * std::abs(x);
                if (x < joint.lower[i] - slack) to = Side::lower;
                if (x > joint.upper[i] + slack) to = Side::upper;
            } else {
                const double off = joint.share[i] * left(joint.rows[i], x);
                if ((side == Side::lower ? off : -off) > 2 * exact_) to = Side::free;
            }
            if (to == side) continue;
            ++wrong;
            side = to;
            if (to != Side::free) x = joint.bound(i);
        }
    }
    return wrong;
}

/// No ellipsoid is left.
DUCTILE_INLINE bool ForestSolver::is_inside() const noexcept {
    for (const IslandBlock& block : island_->blocks) {
        double square = 0;
        for (int k = 0; k < block.count; ++k) {
            const int row = block.first + k;
            const double share =
                joints_[std::size_t(row / axes)].x[row % axes] / block.size[std::size_t(k)];
            square += share * share;
        }
        if (!(square <= 1)) return false;
    }
    return true;
}

/// False where they go in circles.
DUCTILE_INLINE bool ForestSolver::find_sides(IslandReport& report) noexcept {
    constexpr int patience = 3; // rounds without fewer rows in the wrong place
    int fewest = std::numeric_limits<int>::max(), left = patience;
    for (report.rounds = 1; left > 0; ++report.rounds) {
        ++report.factorisations;
        if (!solve_once()) return false;
        const int wrong = change_over();
        if (wrong == 0) return true;
        left = wrong < fewest ? patience : left - 1;
        fewest = std::min(fewest, wrong);
    }
    return false;
}

DUCTILE_INLINE bool ForestSolver::solve(Island& island, IslandReport& report) {
    constexpr double exact = 1e-11, few = 10; // of the largest velocity; bodies
    island_ = &island;
    if (!read() || !(scale_ > 0)) return false;
    IslandReport mine;
    mine.scale = scale_;
    // what rows are off by adds up along a chain, and what turns moves by as much again
    const double along = std::max(1.0, double(island.bodies.size()) / few);
    exact_ = std::min(exact * scale_, unsolved_speed / (along * along));
    if (!find_sides(mine) || !is_inside()) return false;
    for (const Joint& joint : joints_) {
        if (!is_finite(joint.x)) return false;
        for (int i = 0; i < axes; ++i) {
            if (!joint.holds(i)) continue;
            const double off = joint.share[i] * std::abs(this->left(joint.rows[i], joint.x[i]));
            if (!(off <= exact_)) return false;
            mine.residual = std::max(mine.residual, off);
        }
    }
    for (const Joint& joint : joints_) {
        for (int i = 0; i < axes; ++i) {
            joint.rows[i].impulse = joint.x[i];
            joint.rows[i].side = joint.side[std::size_t(i)];
        }
    }
    for (IslandBlock& block : island.blocks) block.multiplier = 0;
    report = mine;
    return true;
}

} // namespace ductile::solve
