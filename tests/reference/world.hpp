// SPDX-License-Identifier: MIT
//
// The reference integrator: a small, dense and exact engine that verifies the core without any
// engine. It drives ductile joints through prepare and commit alone.
//
//   v' = v + M⁻¹ (load dt + Eᵀ μ + Jᵀ λ),   x' = x + v' dt          (symplectic Euler)
//   E v' = target                            rigid rows: pins, rollers, driven bodies
//   J v' + C λ = b, lower dt <= λ <= upper dt   plastic rows, what the joints asked for
//
// The rigid rows are eliminated exactly, so that the boxed problem holds plastic rows only:
//
//   G = M⁻¹ Eᵀ (E M⁻¹ Eᵀ)⁻¹,   Q = I - G E,   P = Q M⁻¹
//   v' = Q v + G target + P (load dt + Jᵀ λ),   A = J P Jᵀ + C
//
// Kinematics. `small`: Jacobians as at the start for ever, which is what the tables of beam theory
// assume. `finite`: pins follow their bodies, and the gap that a step leaves in them is closed
// by moving, not by velocity, so no energy comes in.
//
// Work. Supplied energy is counted as load dt · (v + v')/2, as the joints count theirs, so the
// ledger closes to round-off at any dt. All rows share one account (joint/work_share.hpp).
//
// Symbols ("x | y": sliding | turning)
//   M     mass of a degree of freedom, diagonal  [kg | kg m²]
//   v, x  velocity, displacement                 [m/s | rad/s], [m | rad]
//   load  external force, sampled by the caller  [N | N m]
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/work_share.hpp"
#include "ductile/vocabulary/row.hpp"
#include "reference/boxed_lcp.hpp"

namespace ductile::reference {

template <std::floating_point S>
using Point = Eigen::Matrix<S, 2, 1>;

enum class Kinematics { small, finite };

/// A planar body: three degrees of freedom in a row, x, y and angle. `ground` has none.
struct Body {
    int x = -1;

    [[nodiscard]] int y() const { return x + 1; }
    [[nodiscard]] int angle() const { return x + 2; }
    [[nodiscard]] bool is_ground() const { return x < 0; }
};
inline constexpr Body ground{};

/// One entry of a row whose Jacobian is constant: coefficient × velocity of the degree of freedom.
template <std::floating_point S>
struct Term {
    int degree = 0;
    S coefficient = 1;
};

template <std::floating_point S>
class World {
  public:
    explicit World(Kinematics kinematics = Kinematics::small) : kinematics_(kinematics) {}

    // ---- what there is; nothing may be added after the first step ----------------------------

    /// A degree of freedom that slides or turns alone [kg | kg m²]; returns its number.
    int add_degree(S mass) {
        mass_.push_back(mass);
        return int(mass_.size()) - 1;
    }
    Body add_body(S mass, S inertia, const Point<S>& centre);

    /// Σ coefficient v' = 0, or what `drive` says; returns the row's number for `drive`.
    std::size_t add_rigid_row(std::vector<Term<S>> terms) {
        fixed_rows_.push_back(std::move(terms));
        targets_.push_back(0);
        return fixed_rows_.size() - 1;
    }
    /// Target of a rigid row from now on [m/s | rad/s].
    void drive(std::size_t row, S velocity) { targets_[row] = velocity; }

    /// Bodies a and b share the point `where` (world axes, at the start).
    void add_pin(Body a, Body b, const Point<S>& where) {
        add_roller(a, b, where, Point<S>(1, 0));
        add_roller(a, b, where, Point<S>(0, 1));
    }
    /// They share its component along `direction` only.
    void add_roller(Body a, Body b, const Point<S>& where, const Point<S>& direction);

    /// From now on the rows are not told what mass they move, as by an engine that cannot say.
    void withhold_mass() { mass_known_ = false; }

    /// A plastic row: velocity Σ coefficient v. The joint stays the caller's and must outlive the
    /// world.
    template <class Joint>
    std::size_t add_row(const std::vector<Term<S>>& terms, Joint& joint) {
        rows_.push_back(
            {terms,
             [&joint](const Motion<S>& m, S dt) { return joint.prepare(m, dt); },
             [&joint, booked = BookedStep<Joint>()](const Reaction<S>& r, S dt, S granted) mutable {
                 if (granted < 1) {
                     booked.grant(joint, granted);
                 } else {
                     booked.commit(joint, r, dt);
                 }
                 return booked.step();
             },
             {},
             {}});
        return rows_.size() - 1;
    }
    /// A plastic hinge that turns with the angle of b less that of a.
    template <class Joint>
    std::size_t add_hinge(Body a, Body b, Joint& joint) {
        std::vector<Term<S>> terms;
        if (!a.is_ground()) terms.push_back({a.angle(), S(-1)});
        if (!b.is_ground()) terms.push_back({b.angle(), S(1)});
        return add_row(terms, joint);
    }

    // ---- what it does --------------------------------------------------------------------------

    /// Velocities after this impulse, with rigid rows rigid and plastic rows, which can carry no
    /// impulse, as if they were not there.
    void strike(const Vector<S>& impulse);

    /// One step of `dt` [s] under `load`, one entry per degree of freedom.
    /// @throws std::runtime_error where the boxed problem is not solved exactly.
    void step(S dt, const Vector<S>& load);
    void step(S dt) { step(dt, no_load()); }

    // ---- what it says --------------------------------------------------------------------------

    [[nodiscard]] Eigen::Index degrees() const { return Eigen::Index(mass_.size()); }
    [[nodiscard]] Vector<S> no_load() const;
    /// [m/s | rad/s], of all degrees of freedom; may be set.
    [[nodiscard]] Vector<S>& velocity() {
        resize();
        return velocity_;
    }
    /// From the start [m | rad]; may be set where the rigid rows allow it.
    [[nodiscard]] Vector<S>& displacement() {
        resize();
        return displacement_;
    }
    /// What the row did in the last step.
    [[nodiscard]] const Reaction<S>& reaction(std::size_t row) const { return rows_[row].reaction; }
    [[nodiscard]] const Step<S>& last(std::size_t row) const { return rows_[row].step; }
    [[nodiscard]] S kinetic_energy();
    /// Work of the loads so far [J].
    [[nodiscard]] S supplied() const { return supplied_; }

  private:
    struct PlacedBody {
        Body body;
        Point<S> centre;
    };
    struct PointOnBody {
        Body body;
        Point<S> arm; ///< from its centre, or from the origin for the ground
    };
    struct PointRow {
        PointOnBody a, b;
        Point<S> direction;
    };
    struct Row {
        std::vector<Term<S>> terms;
        std::function<RowLimits<S>(const Motion<S>&, S)> prepare;
        std::function<Step<S>(const Reaction<S>&, S dt, S granted)> commit;
        Reaction<S> reaction;
        Step<S> step;
    };

    [[nodiscard]] Motion<S> motion(S position, S velocity, S inverse_mass) const;

    [[nodiscard]] Point<S> centre(Body body) const;

    /// The arm as the body has turned it, finite kinematics only.
    [[nodiscard]] Point<S> turned(const PointOnBody& point) const;

    [[nodiscard]] Point<S> place(const PointOnBody& point) const;

    void add_point(Matrix<S>& rigid, Eigen::Index row, const PointOnBody& point,
                   const Point<S>& direction, S sign) const;

    [[nodiscard]] Matrix<S> rigid_jacobian() const;

    [[nodiscard]] Vector<S> rigid_targets() const;

    void resize();

    /// Everything that depends on the configuration alone.
    void assemble();

    void close_gaps();

    /// Gives the energy a break took in excess back along its row, rigid rows held.
    void hand_back(Eigen::Index row, S energy);

    Kinematics kinematics_;
    bool mass_known_ = true;
    std::vector<S> mass_;
    std::vector<PlacedBody> bodies_;
    std::vector<std::vector<Term<S>>> fixed_rows_;
    std::vector<S> targets_;
    std::vector<PointRow> point_rows_;
    std::vector<Row> rows_;

    Vector<S> velocity_, displacement_;
    S supplied_ = 0;

    Matrix<S> push_;      ///< G
    Matrix<S> projector_; ///< Q
    Matrix<S> mobility_;  ///< P
    Matrix<S> jacobian_;  ///< J
    Matrix<S> response_;  ///< P Jᵀ
    Matrix<S> coupling_;  ///< J P Jᵀ
    BoxedLcp<S> lcp_;
};

template <std::floating_point S>
void World<S>::strike(const Vector<S>& impulse) {
    assemble();
    velocity_ = projector_ * velocity_ + mobility_ * impulse;
}

template <std::floating_point S>
void World<S>::step(S dt, const Vector<S>& load) {
    assemble();
    const Vector<S> start = velocity_;
    const Vector<S> start_rows = jacobian_ * start;
    const Vector<S> positions = jacobian_ * displacement_;
    Vector<S> free = projector_ * start + dt * (mobility_ * load);
    if (!targets_.empty()) free += push_ * rigid_targets();

    const auto n = Eigen::Index(rows_.size());
    Vector<S> bias(n), lower(n), upper(n);
    Matrix<S> a = coupling_;
    for (Eigen::Index i = 0; i < n; ++i) {
        const RowLimits<S> limits =
            rows_[std::size_t(i)].prepare(motion(positions[i], start_rows[i], coupling_(i, i)), dt);
        bias[i] = limits.bias;
        lower[i] = limits.lower * dt;
        upper[i] = limits.upper * dt;
        a(i, i) += limits.compliance;
    }
    Vector<S> lambda(n);
    if (n > 0) lambda = lcp_.solve(a, jacobian_ * free - bias, lower, upper);
    velocity_ = free + response_ * lambda;
    displacement_ += dt * velocity_;
    supplied_ += dt * load.dot(start + velocity_) / 2;
    if (kinematics_ == Kinematics::finite) close_gaps();

    const Vector<S> end_rows = jacobian_ * velocity_;
    const Vector<S> end_positions = jacobian_ * displacement_;
    for (Eigen::Index i = 0; i < n; ++i) {
        Row& row = rows_[std::size_t(i)];
        row.reaction = {lambda[i] / dt, end_rows[i], end_positions[i]};
        row.step = row.commit(row.reaction, dt, 1);
    }
    WorkShare<S> share;
    for (const Row& row : rows_) share.add(row.step);
    for (Row& row : rows_) {
        if (share.value() < 1 && row.step.claimed > 0) {
            row.step = row.commit(row.reaction, dt, share.value());
        }
    }
    for (Eigen::Index i = 0; i < n; ++i) hand_back(i, rows_[std::size_t(i)].step.release);
}

template <std::floating_point S>
S World<S>::kinetic_energy() {
    const Eigen::Map<const Vector<S>> mass(mass_.data(), degrees());
    return velocity().dot(mass.cwiseProduct(velocity())) / 2;
}

template <std::floating_point S>
Vector<S> World<S>::no_load() const {
    return Vector<S>::Zero(degrees());
}

template <std::floating_point S>
Point<S> World<S>::turned(const PointOnBody& point) const {
    if (kinematics_ == Kinematics::small || point.body.is_ground()) return point.arm;
    const S angle = displacement_[point.body.angle()];
    return Eigen::Rotation2D<S>(angle) * point.arm;
}

template <std::floating_point S>
Point<S> World<S>::place(const PointOnBody& point) const {
    Point<S> at = centre(point.body) + turned(point);
    if (!point.body.is_ground()) {
        at += Point<S>(displacement_[point.body.x], displacement_[point.body.y()]);
    }
    return at;
}

template <std::floating_point S>
void World<S>::add_point(Matrix<S>& rigid, Eigen::Index row, const PointOnBody& point,
                         const Point<S>& direction, S sign) const {
    if (point.body.is_ground()) return;
    const Point<S> arm = turned(point);
    rigid(row, point.body.x) += sign * direction.x();
    rigid(row, point.body.y()) += sign * direction.y();
    rigid(row, point.body.angle()) += sign * (arm.x() * direction.y() - arm.y() * direction.x());
}

template <std::floating_point S>
Matrix<S> World<S>::rigid_jacobian() const {
    const auto fixed = Eigen::Index(fixed_rows_.size());
    Matrix<S> rigid = Matrix<S>::Zero(fixed + Eigen::Index(point_rows_.size()), degrees());
    for (Eigen::Index i = 0; i < fixed; ++i) {
        for (const Term<S>& term : fixed_rows_[std::size_t(i)]) {
            rigid(i, term.degree) += term.coefficient;
        }
    }
    for (Eigen::Index i = fixed; i < rigid.rows(); ++i) {
        const PointRow& row = point_rows_[std::size_t(i - fixed)];
        add_point(rigid, i, row.a, row.direction, S(-1));
        add_point(rigid, i, row.b, row.direction, S(1));
    }
    return rigid;
}

template <std::floating_point S>
Vector<S> World<S>::rigid_targets() const {
    Vector<S> targets = Vector<S>::Zero(push_.cols());
    for (std::size_t i = 0; i < targets_.size(); ++i) targets[Eigen::Index(i)] = targets_[i];
    return targets;
}

template <std::floating_point S>
void World<S>::resize() {
    if (velocity_.size() != degrees()) velocity_ = displacement_ = no_load();
}

template <std::floating_point S>
void World<S>::assemble() {
    if (kinematics_ == Kinematics::small && projector_.size() > 0) return;
    resize();
    const Vector<S> inverse_mass =
        Eigen::Map<const Vector<S>>(mass_.data(), degrees()).cwiseInverse();
    const Matrix<S> rigid = rigid_jacobian();
    const Matrix<S> weighted = inverse_mass.asDiagonal() * rigid.transpose();
    push_ = Matrix<S>::Zero(degrees(), rigid.rows());
    if (rigid.rows() > 0) {
        const Eigen::LDLT<Matrix<S>> factor(rigid * weighted);
        const S regular = S(1e3) * std::numeric_limits<S>::epsilon();
        if (!(factor.vectorD().minCoeff() > regular * factor.vectorD().maxCoeff())) {
            throw std::invalid_argument("World: the rigid rows depend on each other");
        }
        push_ = factor.solve(weighted.transpose()).transpose();
    }
    projector_ = Matrix<S>::Identity(degrees(), degrees()) - push_ * rigid;
    mobility_ = projector_ * inverse_mass.asDiagonal();

    jacobian_ = Matrix<S>::Zero(Eigen::Index(rows_.size()), degrees());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        for (const Term<S>& term : rows_[i].terms) {
            jacobian_(Eigen::Index(i), term.degree) += term.coefficient;
        }
    }
    response_ = mobility_ * jacobian_.transpose();
    coupling_ = jacobian_ * response_;
    coupling_ = (coupling_ + coupling_.transpose().eval()) / 2;
}

template <std::floating_point S>
void World<S>::close_gaps() {
    assemble();
    Vector<S> gap = Vector<S>::Zero(push_.cols());
    const auto fixed = Eigen::Index(fixed_rows_.size());
    for (Eigen::Index i = fixed; i < gap.size(); ++i) {
        const PointRow& row = point_rows_[std::size_t(i - fixed)];
        gap[i] = row.direction.dot(place(row.b) - place(row.a));
    }
    displacement_ -= push_ * gap;
}

template <std::floating_point S>
void World<S>::hand_back(Eigen::Index row, S energy) {
    const S inverse_mass = coupling_(row, row);
    if (!(energy > 0) || !(inverse_mass > 0)) return;
    const S u = jacobian_.row(row).dot(velocity_);
    const S impulse = 2 * energy / (std::abs(u) + std::sqrt(u * u + 2 * energy * inverse_mass));
    velocity_ += response_.col(row) * std::copysign(impulse, u);
}

template <std::floating_point S>
Motion<S> World<S>::motion(S position, S velocity, S inverse_mass) const {
    if (!mass_known_) return {position, velocity};
    const S mass = inverse_mass > 0 ? 1 / inverse_mass : std::numeric_limits<S>::infinity();
    return {position, velocity, mass};
}

template <std::floating_point S>
Point<S> World<S>::centre(Body body) const {
    for (const PlacedBody& placed : bodies_) {
        if (placed.body.x == body.x) return placed.centre;
    }
    return Point<S>::Zero();
}

template <std::floating_point S>
Body World<S>::add_body(S mass, S inertia, const Point<S>& centre) {
    const Body body{add_degree(mass)};
    add_degree(mass);
    add_degree(inertia);
    bodies_.push_back({body, centre});
    return body;
}

template <std::floating_point S>
void World<S>::add_roller(Body a, Body b, const Point<S>& where, const Point<S>& direction) {
    point_rows_.push_back({{a, where - centre(a)}, {b, where - centre(b)}, direction});
}

#ifdef DUCTILE_COMPILED
extern template class World<double>; // tests/support/reference_world.cpp
#endif

} // namespace ductile::reference
