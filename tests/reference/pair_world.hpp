// SPDX-License-Identifier: MIT
//
// Two bodies in space and one link between them, solved exactly: the smallest engine that a link
// can be tested in.
//
//   v' = v + M⁻¹ (load dt + Jᵀ λ),  x' = x + v' dt,  Q' = exp(ω' dt) Q        (symplectic Euler)
//
// by the rows' bounds, or on the ellipsoid of six rows: (A + μ P⁻²) λ = -w, |P⁻¹ λ| = 1, by
// bisection of μ >= 0; without gyroscopic torque: inertias are meant to be spherical, or motions
// short. Loads act on body A at its centre of mass.
#pragma once

#include <Eigen/Geometry>

#include <concepts>
#include <utility>

#include "ductile/joint/link.hpp"
#include "ductile/numeric/lu.hpp"
#include "reference/boxed_lcp.hpp"

namespace ductile::reference {

/// The two bodies, whatever joins them.
template <std::floating_point S>
class BodyPair {
  public:
    [[nodiscard]] BodyState<S>& a() { return a_; }
    [[nodiscard]] BodyState<S>& b() { return b_; }
    /// From now on the surface of six plastic rows that share an ellipsoid is met itself.
    void meet_surfaces() { on_surface_ = true; }
    [[nodiscard]] S supplied() const { return supplied_; } ///< work of the loads [J]
    [[nodiscard]] S kinetic_energy() const { return energy(a_) + energy(b_); }

  protected:
    BodyPair(const BodyState<S>& a, const BodyState<S>& b) : a_(a), b_(b) {}
    void step(AnyLink<S>& link, S dt, const Vector3<S>& force, const Vector3<S>& torque, S rate);

  private:
    static void move(BodyState<S>& body, S dt) {
        body.position += dt * body.velocity;
        const S angle = body.spin.norm() * dt;
        if (angle > 0) {
            body.orientation =
                Eigen::AngleAxis<S>(angle, body.spin.normalized()) * body.orientation;
        }
    }
    static void change(BodyState<S>& body, const VelocityChange<S>& by) {
        body.velocity += by.linear;
        body.spin += by.angular;
    }
    static S energy(const BodyState<S>& body) {
        if (!(body.inverse_mass > 0)) return 0;
        return body.velocity.squaredNorm() / body.inverse_mass / 2 +
               body.spin.dot(numeric::inverse(body.inverse_inertia) * body.spin) / 2;
    }

    /// Impulse on the ellipsoid of the semi-axes `size`, or inside it.
    static Vector<S> on_ellipsoid(const Matrix<S>& a, const Vector<S>& w, const Vector<S>& size) {
        const auto at = [&](S multiplier) -> Vector<S> {
            Matrix<S> left = a;
            left.diagonal() += multiplier * size.cwiseAbs2().cwiseInverse();
            return left.llt().solve(-w);
        };
        const auto gauge = [&](S multiplier) { return at(multiplier).cwiseQuotient(size).norm(); };
        if (gauge(0) <= 1) return at(0);
        S low = 0, high = 1;
        while (gauge(high) > 1) high *= 2;
        for (int i = 0; i < 200; ++i) {
            const S middle = (low + high) / 2;
            (gauge(middle) > 1 ? low : high) = middle;
        }
        return at(high);
    }

    BodyState<S> a_, b_;
    BoxedLcp<S> lcp_;
    bool on_surface_ = false;
    S supplied_ = 0;
};

template <std::floating_point S>
void BodyPair<S>::step(AnyLink<S>& link, S dt, const Vector3<S>& force, const Vector3<S>& torque,
                       S rate) {
    const Vector3<S> v = a_.velocity, w = a_.spin;
    link.prepare(a_, b_, dt, rate);
    a_.velocity += dt * a_.inverse_mass * force;
    a_.spin += dt * a_.inverse_inertia * torque;
    const Vector6<S> semi_axes =
        link.surface() == nullptr ? link.shared_strength() : Vector6<S>(Vector6<S>::Zero());
    const bool on_surface = on_surface_ && semi_axes.minCoeff() > 0 && link.meet_surface(dt, false);
    const Vector3<S> at = link.point();
    Eigen::Matrix<S, 6, 12> jacobian, mobile;
    Vector<S> bias(6), lower(6), upper(6);
    Matrix<S> compliance = Matrix<S>::Zero(6, 6);
    for (int i = 0; i < 6; ++i) {
        const LinkRow<S> row = link.row(all_joint_axes[std::size_t(i)]);
        const Vector3<S> none = Vector3<S>::Zero(), n = row.direction;
        jacobian.row(i) << (row.turns ? none : n).transpose(),
            (row.turns ? n : (at - a_.position).cross(n)).transpose(),
            (row.turns ? none : -n).transpose(),
            (row.turns ? -n : -(at - b_.position).cross(n)).transpose();
        bias[i] = row.limits.bias;
        lower[i] = row.limits.lower * dt;
        upper[i] = row.limits.upper * dt;
        compliance(i, i) = row.limits.compliance;
    }
    mobile << jacobian.template middleCols<3>(0) * a_.inverse_mass,
        jacobian.template middleCols<3>(3) * a_.inverse_inertia,
        jacobian.template middleCols<3>(6) * b_.inverse_mass,
        jacobian.template middleCols<3>(9) * b_.inverse_inertia;
    Eigen::Matrix<S, 12, 1> velocity;
    velocity << a_.velocity, a_.spin, b_.velocity, b_.spin;
    const Matrix<S> a = mobile * jacobian.transpose() + compliance;
    const Vector<S> left = jacobian * velocity - bias;
    const Vector<S> impulse =
        on_surface ? on_ellipsoid(a, left, semi_axes * dt) : lcp_.solve(a, left, lower, upper);
    velocity += mobile.transpose() * impulse;
    a_.velocity = velocity.template segment<3>(0);
    a_.spin = velocity.template segment<3>(3);
    b_.velocity = velocity.template segment<3>(6);
    b_.spin = velocity.template segment<3>(9);
    supplied_ += dt * (force.dot(v + a_.velocity) + torque.dot(w + a_.spin)) / 2;
    JointWrench<S> wrench;
    for (std::size_t i = 0; i < 6; ++i) {
        const LinkRow<S> row = link.row(all_joint_axes[i]);
        (row.turns ? wrench.moment : wrench.force) += row.direction * impulse[Eigen::Index(i)] / dt;
    }
    move(a_, dt);
    move(b_, dt);
    link.commit(a_, b_, wrench, dt);
    const BreakRelease<S> release = link.release(a_, b_);
    change(a_, release.a);
    change(b_, release.b);
}

#ifdef DUCTILE_COMPILED
extern template class BodyPair<double>; // tests/support/reference_world.cpp
#endif

template <class Joint>
class PairWorld : public BodyPair<typename Joint::Scalar> {
    using S = typename Joint::Scalar;

  public:
    PairWorld(const BodyState<S>& a, const BodyState<S>& b, Link<Joint> joined)
        : BodyPair<S>(a, b), link_(std::move(joined)) {
        link_.start(a, b);
    }
    [[nodiscard]] Link<Joint>& link() { return link_; }

    void step(S dt, const Vector3<S>& force = Vector3<S>::Zero(),
              const Vector3<S>& torque = Vector3<S>::Zero(), S rate = 0) {
        BodyPair<S>::step(link_, dt, force, torque, rate);
    }

  private:
    Link<Joint> link_;
};

} // namespace ductile::reference
