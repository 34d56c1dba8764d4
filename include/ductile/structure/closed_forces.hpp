// SPDX-License-Identifier: MIT
//
// What the closed joints of a cluster carry. In one that branches like a tree the loads of a step
// say it; in one with closed frames they do not, and any forces in equilibrium that no joint is too
// weak for prove that the cluster stays whole: the static theorem of limit analysis, and the rows
// of the jointed structure at rest within their bounds.
//
// Forces. Those that were proved last, and what is new on top of it so that
//
//   Σ_j |f_j - f_j0|² (by W) is least,   Σ ± G_j f_j + w = 0 of every body
//   ⇔  K u = -(w + G f0),  K = G W Gᵀ,  f = f0 + W Gᵀ u
//   W = diag(k) of an elastic joint, diag(capacity²) of a rigid one
//
// K has 6 rows a body and is factored once per cluster (numeric/block_ldlt.hpp), in its own frame.
// In an elastic cluster it is the stiffness of the frame, and these are the forces that it comes to
// under the loads, small rotations: where they are beyond the first joint yields on the way there.
// Where these are too much in some joint of a redundant rigid cluster, the weights of joints are
// divided by how much they are used, and again: f then comes near to where the most used one is
// used the least. That is a proof that the cluster stays, where it finds one, and none that it does
// not: whoever then opens joints that would have held has an answer that costs more, and the forces
// of that answer are the next proof.
//
// Symbols
//   f_j  force and moment of joint j on its body A, along its axes  [N], [N m]
//   w    force and moment on a body beside them, about its centre   [N], [N m]
//   G_j  of a joint's six, what they are on a body about its centre
//
// Sources: static theorem: Jirasek & Bazant (2002), Inelastic Analysis of Structures, ch. 4;
// weights: Lawson's algorithm, Rice & Usow (1968), Mathematics of Computation 22, 118.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ductile/numeric/block_ldlt.hpp"
#include "ductile/structure/cluster.hpp"
#include "ductile/structure/structure_plan.hpp"

namespace ductile {

/// Below yield, along all its axes.
[[nodiscard]] inline bool is_elastic(const SectionJoint<double>& joint) {
    return joint.parameters().stiffness.maxCoeff() < std::numeric_limits<double>::infinity();
}

/// A closed joint within a cluster.
struct ClosedJoint {
    std::size_t joint = 0;      ///< of the plan
    int a = 0, b = 0;           ///< bodies, by their place in the cluster; b = -1: the ground
    Matrix6<double> on_a, on_b; ///< G, frame of the cluster
};

class ClosedForces {
  public:
    using Wrench = Vector6<double>; ///< force, moment

    /// `frames`: of the plan's joints in their bodies A, B (of the ground: in the world).
    ClosedForces(const Cluster& cluster, std::span<const std::size_t> closed,
                 const StructurePlan& plan,
                 std::span<const std::pair<JointFrame<double>, JointFrame<double>>> frames) {
        const auto place_in = [&](std::size_t body) {
            const auto found = std::find(cluster.bodies.begin(), cluster.bodies.end(), body);
            return int(found - cluster.bodies.begin());
        };
        free_ = !cluster.held;
        const int count = int(cluster.bodies.size());
        loads_.resize(std::size_t(count));
        std::vector<numeric::BlockLdlt::Edge> edges;
        for (const std::size_t j : closed) {
            const PlanJoint& joint = plan.joints[j];
            ClosedJoint one;
            one.joint = j;
            one.a = place_in(joint.a);
            const JointFrame<double>& at_a = cluster.places[std::size_t(one.a)];
            JointFrame<double> frame = placed(at_a, frames[j].first);
            one.b = joint.b.kind == PlanSeat::Kind::body ? place_in(joint.b.index) : -1;
            // as a joint tells its forces: along the axes of B, where A's frame is
            frame.axes = one.b >= 0
                             ? times(cluster.places[std::size_t(one.b)].axes, frames[j].second.axes)
                             : frames[j].second.axes;
            one.on_a = about(frame, at_a.origin);
            one.on_b = one.b >= 0 ? about(frame, cluster.places[std::size_t(one.b)].origin)
                                  : Matrix6<double>::Zero();
            joints_.push_back(one);
            const SectionJoint<double>& of = joint.joint;
            if (is_elastic(of)) {
                rigid_ = false;
                weights_.push_back(of.parameters().stiffness);
            } else {
                weights_.push_back(of.surface().semi_axes().cwiseAbs2());
            }
            if (row(one.a) >= 0 && row(one.b) >= 0) edges.emplace_back(row(one.a), row(one.b));
        }
        used_ = weights_;
        if (count - (free_ ? 1 : 0) > 0) solver_.set_pattern(count - (free_ ? 1 : 0), edges);
        rows_.resize(std::size_t(std::max(0, count - (free_ ? 1 : 0))));
    }

    [[nodiscard]] const std::vector<ClosedJoint>& joints() const noexcept { return joints_; }
    /// By body of the cluster, its frame: to be filled before `find`.
    [[nodiscard]] std::vector<Wrench>& loads() noexcept { return loads_; }
    /// Share of the loads that no forces carry: of a free cluster, whose loads have to be in
    /// balance with its motion [-].
    [[nodiscard]] double left_over() const noexcept { return left_over_; }
    /// The same as a share of a joint's strength, had it to carry them [-].
    [[nodiscard]] double left_over_use() const noexcept { return left_over_use_; }

    /// The most used joint of `forces`, by plan, which become what carries the loads; no_joint:
    /// none is used beyond 1 + `beyond`; else they stay what they are, those of an elastic cluster
    /// become what they are where it yields. `use(joint, force)`: share of its strength.
    static constexpr std::size_t no_joint = std::size_t(-1);
    template <class Use>
    std::size_t find(std::vector<Wrench>& forces, const Use& use, double beyond) {
        if (joints_.empty()) return no_joint;
        first_.clear();
        for (const ClosedJoint& joint : joints_) first_.push_back(forces[joint.joint]);
        std::size_t worst = carry(forces, use, beyond);
        constexpr int rounds = 40;
        for (int round = 0; worst != no_joint && redundant() && round < rounds; ++round) {
            if (round == 0) penalties_.assign(joints_.size(), 1.0);
            double most = 0;
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                penalties_[i] *= use(joints_[i].joint, forces[joints_[i].joint]);
                most = std::max(most, penalties_[i]);
            }
            constexpr double least = 1e-6;
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                penalties_[i] = std::max(penalties_[i] / most, least);
                used_[i] = weights_[i] / penalties_[i];
            }
            factored_ = false;
            // from nothing: what is proved of other loads has no part in it
            for (const ClosedJoint& joint : joints_) forces[joint.joint].setZero();
            worst = carry(forces, use, beyond);
        }
        if (used_ != weights_) {
            used_ = weights_;
            factored_ = false;
        }
        if (worst == no_joint) return no_joint;
        go_back(forces, rigid_ ? 0 : borne(forces, use));
        return worst;
    }

  private:
    static Matrix6<double> about(const JointFrame<double>& frame, const Vector3<double>& centre) {
        Matrix6<double> g = Matrix6<double>::Zero();
        set_block(g, 0, 0, frame.axes);
        set_block(g, 3, 3, frame.axes);
        set_block(g, 3, 0, times(skew(difference(frame.origin, centre)), frame.axes));
        return g;
    }
    /// Of a free cluster the first body is where all is counted from.
    [[nodiscard]] int row(int body) const noexcept { return free_ ? body - 1 : body; }
    /// Forces are not determined by equilibrium, nor by stiffness.
    [[nodiscard]] bool redundant() const noexcept {
        return rigid_ && joints_.size() > rows_.size();
    }

    /// Of the way from `first_` to `forces`, as far as all joints bear it.
    template <class Use>
    [[nodiscard]] double borne(const std::vector<Wrench>& forces, const Use& use) const {
        const auto bear = [&](double share) {
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                const std::size_t j = joints_[i].joint;
                const Wrench there = first_[i] + share * (forces[j] - first_[i]);
                if (use(j, there) > 1) return false;
            }
            return true;
        };
        double share = 0;
        for (double more = 0.5; more > 1e-12; more /= 2) {
            if (bear(share + more)) share += more;
        }
        return share;
    }
    void go_back(std::vector<Wrench>& forces, double share) const {
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            Wrench& f = forces[joints_[i].joint];
            f = first_[i] + share * (f - first_[i]);
        }
    }

    void factor() {
        solver_.clear();
        for (std::size_t i = 0; i < joints_.size(); ++i) {
            const ClosedJoint& joint = joints_[i];
            const Matrix6<double> weighted_a = joint.on_a * used_[i].asDiagonal(),
                                  weighted_b = joint.on_b * used_[i].asDiagonal();
            const int a = row(joint.a), b = joint.b >= 0 ? row(joint.b) : -1;
            if (a >= 0) solver_.diagonal(a) += weighted_a * joint.on_a.transpose();
            if (b >= 0) solver_.diagonal(b) += weighted_b * joint.on_b.transpose();
            if (a < 0 || b < 0) continue;
            const auto place = solver_.place(a, b);
            const Matrix6<double> between = weighted_a * joint.on_b.transpose();
            if (place.transposed) {
                solver_.off_diagonal(place) -= between.transpose();
            } else {
                solver_.off_diagonal(place) -= between;
            }
        }
        (void)solver_.factor();
        factored_ = true;
    }

    /// Puts what the loads are beyond `forces` on top of them; the most used joint that is beyond.
    template <class Use>
    std::size_t carry(std::vector<Wrench>& forces, const Use& use, double beyond) {
        double scale = 0, left = 0;
        std::vector<Wrench>& rest = rest_;
        rest = loads_;
        for (const Wrench& load : loads_) scale = std::max(scale, load.head<3>().norm());
        for (const ClosedJoint& joint : joints_) {
            const Wrench& f = forces[joint.joint];
            scale = std::max(scale, f.head<3>().norm());
            rest[std::size_t(joint.a)] += joint.on_a * f;
            if (joint.b >= 0) rest[std::size_t(joint.b)] -= joint.on_b * f;
        }
        for (const Wrench& one : rest) left = std::max(left, one.cwiseAbs().maxCoeff());
        constexpr double round_off = 1e-12;
        if (left > round_off * scale && !rows_.empty()) {
            if (!factored_) factor();
            for (int i = 0; i < int(loads_.size()); ++i) {
                if (row(i) >= 0) rows_[std::size_t(row(i))] = -rest[std::size_t(i)];
            }
            solver_.solve(rows_);
            for (std::size_t i = 0; i < joints_.size(); ++i) {
                const ClosedJoint& joint = joints_[i];
                Wrench along = Wrench::Zero();
                if (row(joint.a) >= 0) {
                    along += joint.on_a.transpose() * rows_[std::size_t(row(joint.a))];
                }
                if (joint.b >= 0 && row(joint.b) >= 0) {
                    along -= joint.on_b.transpose() * rows_[std::size_t(row(joint.b))];
                }
                forces[joint.joint] += used_[i].cwiseProduct(along);
            }
        }
        left_over_ = left_over_use_ = 0;
        if (free_) {
            Wrench off = loads_.front();
            for (const ClosedJoint& joint : joints_) {
                if (joint.a == 0) off += joint.on_a * forces[joint.joint];
                if (joint.b == 0) off -= joint.on_b * forces[joint.joint];
            }
            left_over_ = scale > 0 ? off.head<3>().norm() / scale : 0;
            left_over_use_ = use(joints_.front().joint, off);
        }
        std::size_t worst = no_joint;
        double most = 1 + beyond;
        for (const ClosedJoint& joint : joints_) {
            const double used = use(joint.joint, forces[joint.joint]);
            if (!(used > most)) continue;
            most = used;
            worst = joint.joint;
        }
        return worst;
    }

    bool free_ = false, factored_ = false, rigid_ = true;
    std::vector<ClosedJoint> joints_;
    std::vector<Wrench> weights_, used_; ///< W as it is, and of this round
    std::vector<double> penalties_;      ///< by joint of this, of a round
    std::vector<Wrench> loads_, rest_, first_, rows_;
    numeric::BlockLdlt solver_;
    double left_over_ = 0, left_over_use_ = 0;
};

} // namespace ductile
