// SPDX-License-Identifier: MIT
//
// The course of a step of any_link.hpp: templates, seen everywhere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ductile/joint/any_link.hpp"
#include "ductile/vocabulary/finite.hpp"

namespace ductile {

namespace detail {

/// Beside the size of what is off [-].
template <std::floating_point S>
inline constexpr S small_error = S(1e-2);

/// Of `rate` [1/s], that at which a part removes what rigid rows are `off` by [m | rad] so that it
/// throws nothing: with a 50th of the `speed` [m/s | rad/s] at which their bodies sweep, a
/// 2500th of that energy, or what is small beside their `size` [m | 1]. Pieces that turned by a
/// radian in a long part are centimetres off; removed in 5 ms these gave 10^12 times the energy
/// that there was.
template <std::floating_point S>
[[nodiscard]] S removal_rate(S rate, S off, S speed, S size) noexcept {
    constexpr S slow = 10, swept = S(0.02); // [1/s] [-]
    const S most = std::max(swept * speed, small_error<S> * rate * size);
    return rate * off > most ? std::min(rate, std::max(slow, most / off)) : rate;
}

} // namespace detail

template <std::floating_point S>
void AnyLink<S>::start(const BodyState<S>& a, const BodyState<S>& b) noexcept {
    pose_.look(a, b);
    pose_.set_rest(Matrix3<S>::Identity());
    const Vector6<S> q = strain();
    set_offset(q);
    turn_rest(angular(q));
}

template <std::floating_point S>
void AnyLink<S>::teleport(const BodyState<S>& a, const BodyState<S>& b) noexcept {
    if (pose_.is_now(a, b)) return;
    const bool was_somewhere = pose_.finite();
    const Vector6<S> before = strain();
    pose_.look(a, b);
    if (!was_somewhere || !pose_.finite()) return;
    Vector6<S> moved = strain(), rest = offset();
    for (int i = 0; i < 6; ++i) {
        moved[i] = plastic_[std::size_t(i)] ? moved[i] - before[i] : S(0);
        rest[i] += moved[i];
    }
    const Vector3<S> kept = difference(pose_.elastic_rotation(), angular(moved));
    set_offset(rest);
    if (!is_zero(angular(moved))) {
        pose_.set_rest(turned_by<S>(scaled(-1, kept), pose_.orientation()));
    }
}

template <std::floating_point S>
const typename AnyLink<S>::Limits& AnyLink<S>::prepare(const BodyState<S>& a, const BodyState<S>& b,
                                                       S dt, S rate, bool ahead) noexcept {
    Vector6<S> before; // the rows of a part begin where they were before it
    if (ahead) before = strain();
    pose_.look(a, b);
    on_surface_ = false;
    island_unsolved_ = 0;
    sound_ = pose_.finite();
    ahead_ = ahead;
    const Vector6<S> now = strain();
    if (!ahead) before = now;
    turning_ =
        ahead ? pose_.turning(a, b, linear(offset()), dt, totals().flowing) : RowTurning<S>();
    if (sound_) start_ = turning_.before(pose_.twist(a, b));
    if (damping_ > 0 && sound_ && is_kicked(dt)) { // what is at rest is damped, not what was struck
        damping_ = 0;
        swing_.kick();
    }
    const Vector6<S> turned = turning_.target();
    asked_ = linear(turned);
    const bool whole = !broken() && sound_;
    const std::array<S, 2> rates =
        ahead ? removal_rates(before, a, b, rate) : std::array{rate, rate};
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const auto k = Eigen::Index(i);
        limits_[i] = {.bias = turned[k] - rates[i / 3] * before[k]};
        if (!whole) limits_[i] = {.lower = 0, .upper = 0};
    }
    if (!sound_) return limits_;
    if (reads_mass()) {
        const Matrix6<S> k = pose_.inverse_mass(a, b);
        if (!one_axis_ || !all_rigid_) take_mass(k);
        if (blow_.may_have()) blow_.take_mass(k, plastic_);
    }
    prepare_joint({now - turning_.across * (dt / 4), before, start_, turning_}, dt, ahead);
    return limits_;
}

template <std::floating_point S>
bool AnyLink<S>::may_turn_at_end(const Vector3<S>& spin_a, const Vector3<S>& spin_b,
                                 S dt) const noexcept {
    constexpr S nothing = S(1e-9); // [rad]
    const S spin = std::max(dot(spin_a, spin_a), dot(spin_b, spin_b));
    return !(spin * dt * dt <= nothing * nothing) ||
           norm(asked_) > noticed_turn * allowed_.absolute_residual;
}

template <std::floating_point S>
std::array<S, 2> AnyLink<S>::removal_rates(const Vector6<S>& strain, const BodyState<S>& a,
                                           const BodyState<S>& b, S rate) const noexcept {
    std::array<S, 2> off{}; // squares
    for (std::size_t i = 0; i < plastic_.size(); ++i) {
        const S one = plastic_[i] ? S(0) : strain[Eigen::Index(i)];
        off[i / 3] += one * one;
    }
    const Vector3<S>&on_a = pose_.arm_a(), &on_b = pose_.arm_b();
    constexpr S small = detail::small_error<S> * detail::small_error<S>;
    if (!(off[0] > small * (dot(on_a, on_a) + dot(on_b, on_b))) && !(off[1] > small)) {
        return {rate, rate}; // whatever sweeps
    }
    return {detail::removal_rate(rate, std::sqrt(off[0]),
                                 norm(cross(a.spin, on_a)) + norm(cross(b.spin, on_b)),
                                 norm(on_a) + norm(on_b)),
            detail::removal_rate(rate, std::sqrt(off[1]), norm(a.spin) + norm(b.spin), S(1))};
}

template <std::floating_point S>
Vector3<S> AnyLink<S>::turn_at_end(const BodyState<S>& a, const BodyState<S>& b, S dt) noexcept {
    const Vector3<S> none = Vector3<S>::Zero();
    const S spin = std::sqrt(std::max(dot(a.spin, a.spin), dot(b.spin, b.spin)));
    if (!ahead_ || !sound_ || broken() || !(spin * dt <= small_turn<S> / 2)) return none;
    const Vector3<S> asked =
        linear(pose_.turning(a, b, linear(offset()), dt, totals().flowing).target());
    Vector3<S> change = difference(asked, asked_);
    for (int i = 0; i < 3; ++i) {
        if (plastic_[std::size_t(i)]) change[i] = 0;
    }
    if (!(norm(change) > noticed_turn * allowed_.absolute_residual)) return none;
    for (std::size_t i = 0; i < 3; ++i) limits_[i].bias += change[Eigen::Index(i)];
    return change;
}

template <std::floating_point S>
const Step<S>& AnyLink<S>::commit(const BodyState<S>& a, const BodyState<S>& b,
                                  const JointWrench<S>& wrench, S dt) noexcept {
    return commit_rows(a, b, pose_.along_rows(wrench.force, wrench.moment), dt);
}

template <std::floating_point S>
const Step<S>& AnyLink<S>::commit_rows(const BodyState<S>& a, const BodyState<S>& b,
                                       const Vector6<S>& forces, S dt) noexcept {
    // velocities belong to the rows that were solved, positions to where the bodies are now
    const Vector6<S> velocity = pose_.twist(a, b);
    end_ = turning_.after(velocity);
    constexpr S instant = S(1e-8); // a blow is no longer
    // a force that was there before, such as a weight, is none of what was given
    const bool told = length_ > instant;
    unfit_ = ahead_ ? struck(a, told ? Vector6<S>(forces - force_) : forces, dt) : S(0);
    if (dt > instant) before_blow_ = end_;
    const bool sound = sound_ && is_finite(velocity) && is_finite(forces);
    certify_rigid_rows(a, velocity);
    unseen_turn_ = std::max(pose_.unseen_turn(a, b, ahead_ ? dt / 2 : dt), turned_too_far());
    pose_.look(a, b);
    if (axes().size() > 1) turned_ = end_ + pose_.twist(a, b) - velocity;
    length_ = dt;
    if (!broken() && !(sound && pose_.finite())) {
        unseen_turn_ = 0;
        rigid_residual_ = std::numeric_limits<S>::infinity();
        rigid_unsolved_ = true;
        leave_unbooked();
        return last();
    }
    force_ = forces;
    commit_joint(end_, a, b, dt);
    if (all_rigid_) {
        if (ahead_ || broken()) { // a frame strikes what closes in it
            blow_.forget();
        } else {
            blow_.see(force_, last().plastic_work > 0, dt, plastic_,
                      [this](std::size_t i) { return strength(JointAxis(i)); });
        }
        S fastest = 0;
        for (std::size_t i = 0; i < plastic_.size(); ++i) {
            if (plastic_[i]) fastest = std::max(fastest, std::abs(end_[Eigen::Index(i)]));
        }
        swing_.step(last().plastic_work > 0 && fastest > allowed_.absolute_residual, dt);
    } else { // what it holds is its strength at the travel to yield: a rate that is its own
        const S held = SwingState<S>::band * totals().stored;
        swing_.step(utilisation(), last().plastic_work * SwingState<S>::waits > held * dt, dt);
    }
    return last();
}

template <std::floating_point S>
S AnyLink<S>::borne_error() const noexcept {
    if (!(borne_blow() > 0)) return 0;
    S least = std::numeric_limits<S>::infinity();
    for (const JointAxis axis : axes()) least = std::min(least, strength(axis));
    const S error = borne_blow() / (totals().plastic_work + least * least_travel());
    return error > allowed_.step_error ? error : S(0);
}

template <std::floating_point S>
bool AnyLink<S>::is_kicked(S dt) const noexcept {
    if (all_rigid_) return false;
    const Vector6<S> stiffness = section_stiffness();
    for (std::size_t i = 0; i < plastic_.size(); ++i) {
        const auto k = Eigen::Index(i);
        const S kick = std::abs(start_[k] - before_blow_[k]);
        if (!plastic_[i] || !(kick > allowed_.absolute_residual)) continue;
        if (kick * dt / 2 * stiffness[k] > SwingState<S>::band * strength(JointAxis(i))) {
            return true;
        }
    }
    return false;
}

template <std::floating_point S>
S AnyLink<S>::struck(const BodyState<S>& a, const Vector6<S>& forces, S dt) const noexcept {
    S sum = 0;
    for (std::size_t i = 0; i < plastic_.size(); ++i) {
        const auto k = Eigen::Index(i);
        // what turning leaves is neither of what was given nor of the part before
        const S given = std::min(std::abs(start_[k]), std::abs(start_[k] - before_blow_[k]));
        const S left = i < 3 ? turning_speed() : S(0);
        if (plastic_[i] || !(given > allowed_.absolute_residual + left)) continue;
        if (within(given - left, i < 3 ? pose_.speed_of_a(a) : norm(a.spin))) continue;
        sum += std::abs(forces[k]) * given * dt / 2;
    }
    return sum;
}

template <std::floating_point S>
BreakRelease<S> AnyLink<S>::release(const BodyState<S>& a, const BodyState<S>& b) const noexcept {
    if (!(last().release > 0)) return {};
    return break_release(pose_.at_joint(a), pose_.at_joint(b), pose_.in_world(flow()),
                         pose_.twist_in_world(a, b), last().release);
}

template <std::floating_point S>
JointImpulse<S> AnyLink<S>::release_impulse(const BodyState<S>& a,
                                            const BodyState<S>& b) const noexcept {
    if (!(last().release > 0)) return {};
    return ductile::release_impulse(pose_.at_joint(a), pose_.at_joint(b), pose_.in_world(flow()),
                                    pose_.twist_in_world(a, b), last().release);
}

template <std::floating_point S>
inline Vector6<S> AnyLink<S>::strain() const noexcept {
    Vector6<S> result = twist_of(pose_.displacement(), pose_.elastic_rotation());
    const Vector6<S> rest = offset();
    for (int i = 0; i < 3; ++i) result[i] -= rest[i];
    return result;
}

template <std::floating_point S>
inline void AnyLink<S>::certify_rigid_rows(const BodyState<S>& a,
                                           const Vector6<S>& velocity) noexcept {
    std::array<S, 2> worst{}; // of translations and rotations
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        if (plastic_[i]) continue;
        const S residual = std::abs(velocity[Eigen::Index(i)] - limits_[i].bias);
        worst[i / 3] = worse(worst[i / 3], residual);
    }
    rigid_residual_ = worse(worst[0], worst[1]);
    rigid_unsolved_ = !(rigid_residual_ <= allowed_.absolute_residual) &&
                      !(within(worst[0], pose_.speed_of_a(a)) && within(worst[1], norm(a.spin)));
}

template <std::floating_point S>
inline void AnyLink<S>::turn_rest(const Vector3<S>& flow) noexcept {
    Vector3<S> turn = Vector3<S>::Zero();
    for (int i = 0; i < 3; ++i) {
        if (plastic_[std::size_t(3 + i)]) turn[i] = flow[i];
    }
    if (several_turn_) {
        const Vector3<S> back = difference(turn, pose_.elastic_rotation());
        pose_.set_rest(turned_by<S>(back, pose_.orientation()));
    } else {
        pose_.set_rest(is_zero(turn) ? pose_.rest() : turned_by<S>(turn, pose_.rest()));
    }
}

} // namespace ductile
