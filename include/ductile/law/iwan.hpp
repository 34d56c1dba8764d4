// SPDX-License-Identifier: MIT
//
// Parallel elastic-slip elements (Iwan): a hinge that yields by and by, remembers its reversals and
// rejoins the branch it left, as Masing's rule says. The elements are a multilinear backbone taken
// apart: element i, of stiffness k_i, slips at F_i.
//
//   f_i = clamp(k_i (q - s_i), -F_i, F_i),   s_i = q - f_i / k_i while it slips
//   F = Σ f_i + k_f q
//
// Symbols ("x | y": translational row | rotational row)
//   q    position                                    [m | rad]
//   s_i  slip of element i                           [m | rad]
//   k_i  stiffness of element i                      [N/m | N m/rad]
//   F_i  slip force of element i                     [N | N m]
//   k_f  final stiffness, that of a spring beside the elements, which does not slip [N/m | N m/rad]
//
// From a concave backbone (u_i, F_i), c_i the secant of the piece that ends there, c_{n+1} = k_f:
//
//   k_i = c_i - c_{i+1},   slip force k_i u_i
//
// Each element is solved exactly along a straight path, so cutting a path without reversals
// changes nothing. Loop energy between ±u_a: Σ 4 F_i (u_a - F_i/k_i)₊ (plus nothing for k_f).
//
// As the law of a joint. Taken out in series, the spring K = Σ k_i + k_f of a first loading leaves
// a rigid part that flows by q_p = q - F/K, and that depends on the slips alone:
//
//   q_p = Σ k_i s_i / K
//   towards d = ±1 element i slips from b_i = d s_i + F_i/k_i on, so flow by δ has brought d q to x
//   with
//     Σ k_i (x - b_i)₊ = K δ,   F = K (d x - q_p - d δ),   dF/dq_p = K (K/Σ_{b_i <= x} k_i - 1)
//   held beside F²/(2K):   (Σ k_i s_i² - K q_p²)/2
//
// Hence this law in a OneAxisJoint of the stiffness K is the elements themselves; with another
// stiffness k it is they with 1/k - 1/K in series.
//
// Limit cases: one element is elastic-perfectly plastic; one element and k_f is Prager's law.
//
// Source: Masing (1926), Proc. 2nd Int. Congr. Appl. Mech., 332-335; Iwan (1966), J. Appl. Mech.
// 33, 893-900, doi:10.1115/1.3625199.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "ductile/law/cyclic.hpp"
#include "ductile/law/multilinear.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

template <std::floating_point S>
struct IwanElement {
    S stiffness = std::numeric_limits<S>::quiet_NaN();  ///< k_i [N/m | N m/rad], > 0
    S slip_force = std::numeric_limits<S>::quiet_NaN(); ///< F_i [N | N m], > 0
};

/// A pair of a first loading from rest.
template <std::floating_point S>
struct BackbonePoint {
    S position = std::numeric_limits<S>::quiet_NaN(); ///< u_i [m | rad]
    S force = std::numeric_limits<S>::quiet_NaN();    ///< F_i [N | N m]
};

/// Slips of the elements. Plain value.
template <std::floating_point S, std::size_t N>
struct IwanState {
    std::array<S, N> slip{}; ///< s_i [m | rad]

    bool operator==(const IwanState&) const = default;
};

/// At most N elements. Immutable value; O(size()) and noexcept after construction.
template <std::floating_point S, std::size_t N>
class Iwan {
  public:
    using Scalar = S;
    using State = IwanState<S, N>;

    /// `final_stiffness` k_f >= 0 [N/m | N m/rad].
    /// @throws std::invalid_argument where an element is not positive and finite, or where there
    /// are none or more than N.
    explicit Iwan(std::span<const IwanElement<S>> elements, S final_stiffness = 0)
        : final_(check::non_negative("Iwan.final_stiffness", final_stiffness, "N/m or N m/rad")),
          total_(final_) {
        check_size(elements.size(), 1);
        for (std::size_t i = 0; i < elements.size(); ++i) {
            const std::string field = "Iwan.elements[" + std::to_string(i) + "].";
            add({check::positive(field + "stiffness", elements[i].stiffness, "N/m or N m/rad"),
                 check::positive(field + "slip_force", elements[i].slip_force, "N or N m")});
        }
    }

    /// Takes a backbone apart: positions and forces as pairs after (0, 0), which is not given. The
    /// secant must fall from piece to piece; a piece that goes on straight needs no element.
    /// @throws std::invalid_argument where it rises, a pair is out of order, or there are none or
    /// more than N.
    [[nodiscard]] static Iwan from_backbone(std::span<const BackbonePoint<S>> points,
                                            S final_stiffness = 0) {
        Iwan iwan(check::non_negative("Iwan.final_stiffness", final_stiffness, "N/m or N m/rad"));
        check_size(points.size(), 1);
        const S first = secant(points, 0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const S next = i + 1 < points.size() ? secant(points, i + 1) : final_stiffness;
            const S stiffness = secant(points, i) - next;
            if (stiffness > straight * first) {
                iwan.add({stiffness, stiffness * points[i].position});
            } else if (!(stiffness >= -straight * first)) {
                check::fail("Iwan.backbone[" + std::to_string(i) + "]: secant of the next piece",
                            next, "N/m or N m/rad", "at most that of this piece");
            }
        }
        check_size(iwan.size_, 1);
        return iwan;
    }

    /// A law over plastic travel with an elastic stiffness k [N/m | N m/rad] in series, as
    /// hysteresis.
    /// @throws std::invalid_argument as above; the law must harden ever less.
    template <std::size_t Capacity>
    [[nodiscard]] static Iwan from_law(const Multilinear<S, Capacity>& law, S stiffness) {
        check::positive("Iwan.stiffness", stiffness, "N/m or N m/rad");
        std::array<BackbonePoint<S>, Capacity> points;
        for (std::size_t i = 0; i < law.size(); ++i) {
            const StrengthPoint<S> pair = law.point(i);
            points[i] = {pair.travel + pair.strength / stiffness, pair.strength};
        }
        return from_backbone(std::span<const BackbonePoint<S>>(points.data(), law.size()));
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Element `i` < size().
    [[nodiscard]] const IwanElement<S>& element(std::size_t i) const noexcept {
        return elements_[i];
    }
    [[nodiscard]] S stiffness() const noexcept { return total_; } ///< K [N/m | N m/rad]

    // ---- driven by the position
    // ---------------------------------------------------------------------

    HysteresisStep<S> project(State& state, S position) const noexcept {
        HysteresisStep<S> step{.force = final_ * position};
        for (std::size_t i = 0; i < size_; ++i) {
            const auto [stiffness, limit] = elements_[i];
            const S trial = stiffness * (position - state.slip[i]);
            const S force = std::clamp(trial, -limit, limit);
            step.force += force;
            if (force == trial) continue;
            const S slipped = (trial - force) / stiffness;
            state.slip[i] += slipped;
            step.plastic_increment += stiffness * slipped;
            step.dissipated += force * slipped;
        }
        step.plastic_increment /= total_;
        return step;
    }

    [[nodiscard]] S force(const State& state, S position) const noexcept {
        S force = final_ * position;
        for (std::size_t i = 0; i < size_; ++i) {
            force += elements_[i].stiffness * (position - state.slip[i]);
        }
        return force;
    }
    [[nodiscard]] S held(const State& state, S position) const noexcept {
        S twice = final_ * position * position;
        for (std::size_t i = 0; i < size_; ++i) {
            const S stretch = position - state.slip[i];
            twice += elements_[i].stiffness * stretch * stretch;
        }
        return twice / 2;
    }

    // ---- as a row that flows, K taken out in series
    // -------------------------------------------------

    [[nodiscard]] ForceRange<S> prepare(const State& state, S predicted) const noexcept {
        return {.lower = resistance(state, std::max(-predicted, S(0)) / 2, S(-1)),
                .upper = resistance(state, std::max(predicted, S(0)) / 2, S(1))};
    }
    FlowWork<S> commit(State& state, S increment) const noexcept {
        const S direction = std::copysign(S(1), increment), before = stored(state);
        const S end = run(state, std::abs(increment), direction).position;
        FlowWork<S> work;
        for (std::size_t i = 0; i < size_; ++i) {
            const S slipped = std::max(end - onset(state, i, direction), S(0));
            state.slip[i] += direction * slipped;
            work.dissipated += elements_[i].slip_force * slipped;
        }
        work.stored = stored(state) - before;
        return work;
    }
    [[nodiscard]] S resistance(const State& state, S travel, S direction) const noexcept {
        const S position = run(state, travel, direction).position;
        return total_ * (direction * (position - travel) - plastic_position(state));
    }
    [[nodiscard]] S tangent(const State& state, S travel, S direction) const noexcept {
        return total_ * (total_ / run(state, travel, direction).slipping - 1);
    }
    /// q_p [m | rad]
    [[nodiscard]] S plastic_position(const State& state) const noexcept {
        S sum = 0;
        for (std::size_t i = 0; i < size_; ++i) sum += elements_[i].stiffness * state.slip[i];
        return sum / total_;
    }
    [[nodiscard]] S stored(const State& state) const noexcept {
        S twice = 0;
        const S mean = plastic_position(state);
        for (std::size_t i = 0; i < size_; ++i) {
            const S off = state.slip[i] - mean;
            twice += elements_[i].stiffness * off * off;
        }
        return (twice + final_ * mean * mean) / 2; // Σ k_i s_i² - K q_p² without its cancellation
    }

  private:
    /// Where flow has brought the elements.
    struct Run {
        S position; ///< x, along the flow [m | rad]
        S slipping; ///< Σ k_i of the elements that slip [N/m | N m/rad]
    };

    /// b_i [m | rad]
    [[nodiscard]] S onset(const State& state, std::size_t i, S direction) const noexcept {
        return direction * state.slip[i] + elements_[i].slip_force / elements_[i].stiffness;
    }
    /// Solves Σ k_i (x - b_i)₊ = K `travel` piece by piece, from the first onset to the next;
    /// O(size()²).
    [[nodiscard]] Run run(const State& state, S travel, S direction) const noexcept {
        const S infinity = std::numeric_limits<S>::infinity();
        S position = infinity;
        for (std::size_t i = 0; i < size_; ++i) {
            position = std::min(position, onset(state, i, direction));
        }
        S left = total_ * travel, slipping = 0;
        for (std::size_t piece = 0; piece < size_; ++piece) {
            S next = infinity;
            slipping = 0;
            for (std::size_t i = 0; i < size_; ++i) {
                const S begin = onset(state, i, direction);
                if (begin <= position) {
                    slipping += elements_[i].stiffness;
                } else {
                    next = std::min(next, begin);
                }
            }
            const S room = slipping * (next - position);
            if (!(left >= room)) break;
            left -= room;
            position = next;
        }
        return {position + left / slipping, slipping};
    }

    /// A change of stiffness below this share of the elastic one is round-off of the pairs.
    static constexpr S straight = 64 * std::numeric_limits<S>::epsilon();

    explicit Iwan(S final_stiffness) noexcept : final_(final_stiffness), total_(final_stiffness) {}

    void add(const IwanElement<S>& element) noexcept {
        elements_[size_++] = element;
        total_ += element.stiffness;
    }
    static void check_size(std::size_t size, std::size_t least) {
        if (size < least || size > N) {
            check::fail("Iwan.size", S(size), "", "in [1, " + std::to_string(N) + "]");
        }
    }
    static S secant(std::span<const BackbonePoint<S>> points, std::size_t i) {
        const std::string field = "Iwan.backbone[" + std::to_string(i) + "].";
        const BackbonePoint<S> from = i > 0 ? points[i - 1] : BackbonePoint<S>{0, 0};
        check::between(field + "position", points[i].position, from.position,
                       std::numeric_limits<S>::infinity(), "m or rad");
        check::positive(field + "force", points[i].force, "N or N m");
        return (points[i].force - from.force) / (points[i].position - from.position);
    }

    S final_;
    S total_;
    std::size_t size_ = 0;
    std::array<IwanElement<S>, N> elements_{};
};

static_assert(HysteresisLaw<Iwan<double, 4>> && HysteresisLaw<Iwan<float, 1>>);
static_assert(RestsByItself<Iwan<double, 4>> && RestsByItself<Iwan<float, 1>>);

} // namespace ductile
