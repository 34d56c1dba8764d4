// SPDX-License-Identifier: MIT
//
// How much detail a joint needs: rigid, rigid-plastic on some of its six axes, or elastic-plastic,
// with the reason as text. For scene building, not for the inner loop: it allocates.
//
// 1. Which axes yield. Let n_i be the force axis i sees in its event (elastic, so with its dynamic
//    amplification) over its capacity.
//    - All rigid where (1 + margin) Σ n_i <= 1. Every convex surface through the six capacities
//      contains the octahedron Σ |n_i| <= 1, so this holds for any of them.
//    - Otherwise the axes with the smallest n_i stay rigid as long as the strength they would have
//      taken from the others is tolerable, Σ ((1 + margin) n_i)² <= tolerance. The square is
//      exact for axial force on a rectangle (m = 1 - n²), on the safe side for an ellipsoid
//      (1 - √(1 - n²) <= n²), and up to 1/4 low for thin tubes; an I section bent about its strong
//      axis under axial force loses more: give it a smaller tolerance.
//    An axis whose event is not known may see anything, n_i = ∞, unless other axes cannot transmit
//    so much: between two sections a distance ℓ apart, with nothing in between, the shear force
//    is (M_1 + M_2)/ℓ <= 2 M_p/ℓ. (With mass in between this bounds a slow load, not an impact.)
// 2. Whether the elastic part matters. Without it the peak displacement changes by
//        error = |u_ep - u_rp| / u_ep
//    both in closed form (peak_response.hpp). For an axis that is hit with the energy E this is
//    U_y/(E + U_y), U_y = R²/(2k) the most it can store: a hard hit needs no elastic part. For a
//    load F < R put on at once it is 1: without elasticity nothing moves. Under a load F < R held
//    during a hit, u_ep - u_rp = U_y/(R - F). What the step adds to it is not in this choice, in
//    which the step is given; model_choice.hpp chooses both.
// 3. Whether the step resolves it. The explicit spring (symplectic Euler), a = k dt²/m, 2π/√a steps
//    per period, moves with velocities half a step late: amplitudes are off by a/8, energies by
//    a/4. So
//        error = a/4 = (π / steps per period)²
//    beside what any detail is off by in such an engine, where a load seems to act dt/2 before the
//    speed it meets, and Nikula's frequency ratio `steps_per_period` is the least to accept.
//    The elastic part is used where 2. is beyond the tolerance and 3. is accepted and the smaller
//    error; where the event is not known, wherever 3. is within the tolerance, because that cannot
//    harm. Otherwise the axis is rigid-plastic, and the error that remains is told.
//
// Limit cases: k → ∞ rigid-plastic, error 0; dt → 0 never worse than the tolerance; loads → 0
// rigid.
//
// Source: frequency ratio from Nikula (2017), Handling of plasticity in physics engine,
// section 2.9, which drops the spring where it is too low; errors derived here.
//
// Axes in the order Fx, Fy, Fz, Mx, My, Mz of section/capacity.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "ductile/fidelity/peak_response.hpp"
#include "ductile/section/capacity.hpp"
#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/number_text.hpp"

namespace ductile {

enum class AxisDetail { rigid, rigid_plastic, elastic_plastic };

[[nodiscard]] constexpr std::string_view to_string(AxisDetail detail) noexcept {
    switch (detail) {
        case AxisDetail::rigid:
            return "rigid";
        case AxisDetail::rigid_plastic:
            return "rigid-plastic";
        case AxisDetail::elastic_plastic:
            return "elastic-plastic";
    }
    return "unknown";
}

inline constexpr std::array<std::string_view, 6> joint_axis_names{"Fx", "Fy", "Fz",
                                                                  "Mx", "My", "Mz"};

template <std::floating_point S>
struct JointDetailParameters {
    JointCapacity<S> capacity{}; ///< capacities and stiffnesses, > 0, infinity allowed
    std::array<S, 6> mass{};     ///< effective, of each axis alone [kg | kg m²], > 0
    /// Plastic displacement at which each axis breaks [m | rad], > 0; infinity: never.
    std::array<S, 6> limit = no_limits();
    S dt = std::numeric_limits<S>::quiet_NaN();         ///< step [s], > 0
    std::array<std::optional<AxisEvent<S>>, 6> event{}; ///< none: not known
    S lever = std::numeric_limits<S>::infinity();       ///< ℓ [m], > 0; infinity: bounds no shear
    S tolerance = S(0.05);      ///< relative error of peak displacement and of strength, in (0, 1)
    S margin = S(0.1);          ///< by which loads may turn out larger, >= 0
    S steps_per_period = S(12); ///< fewest for an elastic part, >= 2

    [[nodiscard]] static constexpr std::array<S, 6> no_limits() noexcept {
        std::array<S, 6> limits{};
        limits.fill(std::numeric_limits<S>::infinity());
        return limits;
    }
};

/// What is chosen for one axis.
template <std::floating_point S>
struct AxisChoice {
    AxisDetail detail = AxisDetail::rigid;
    S utilisation = 0;      ///< n; infinity: not known [-]
    S error = 0;            ///< of the peak displacement by this choice; infinity: not known [-]
    S steps_per_period = 0; ///< of the elastic part alone; 0: no elastic part [-]
    std::string reason;
};

template <std::floating_point S>
struct JointDetail {
    std::array<AxisChoice<S>, 6> axis;

    /// The most detailed of the six.
    [[nodiscard]] AxisDetail detail() const noexcept {
        return std::max_element(axis.begin(), axis.end(),
                                [](const auto& a, const auto& b) { return a.detail < b.detail; })
            ->detail;
    }

    /// One line per axis.
    [[nodiscard]] std::string reason() const {
        std::string text;
        for (std::size_t i = 0; i < axis.size(); ++i) {
            text += std::string(joint_axis_names[i]) + " " +
                    std::string(to_string(axis[i].detail)) + ": " + axis[i].reason + "\n";
        }
        return text;
    }
};

namespace detail_choice {

/// 12.3 -> "12.3", short enough to read.
template <std::floating_point S>
std::string number(S value) {
    return number_text(value, 3);
}
template <std::floating_point S>
std::string percent(S share) {
    return number(100 * share) + " %";
}

template <std::floating_point S>
S shear_bound(const JointDetailParameters<S>& p, std::size_t axis) {
    if (axis > 1 || std::isinf(p.lever)) return std::numeric_limits<S>::infinity();
    return 2 * p.capacity.capacity[axis == 0 ? 4 : 3] / p.lever; // Fx bends about y, Fy about x
}

template <std::floating_point S>
S utilisation(const JointDetailParameters<S>& p, const AxisSystem<S>& system, std::size_t axis) {
    if (std::isinf(system.strength)) return 0;
    S force = shear_bound(p, axis);
    if (p.event[axis]) {
        AxisSystem<S> elastic = system;
        elastic.strength = std::numeric_limits<S>::infinity(); // what it would have to carry
        force = std::min(force, peak_response(elastic, *p.event[axis]).force);
    }
    return force / system.strength;
}

/// Detail of an axis that yields.
template <std::floating_point S>
void choose_plastic(const JointDetailParameters<S>& p, const AxisSystem<S>& system,
                    const std::optional<AxisEvent<S>>& event, AxisChoice<S>& choice) {
    constexpr S pi = std::numbers::pi_v<S>, infinity = std::numeric_limits<S>::infinity();
    const S steps = choice.steps_per_period;
    const S resolved = steps > 0 ? (pi / steps) * (pi / steps) : infinity;
    const bool accepted = steps >= p.steps_per_period;
    S ignored = infinity;
    if (event) {
        AxisSystem<S> rigid = system;
        rigid.stiffness = infinity;
        const S with = peak_response(system, *event).displacement;
        const S without = peak_response(rigid, *event).displacement;
        ignored = std::isinf(with) || with <= 0 ? S(0) : std::abs(with - without) / with;
    }
    if (std::isinf(system.stiffness)) ignored = 0;

    const bool elastic =
        accepted && ignored > p.tolerance && resolved < (event ? ignored : p.tolerance);
    choice.detail = elastic ? AxisDetail::elastic_plastic : AxisDetail::rigid_plastic;
    choice.error = elastic ? resolved : ignored;
    const std::string period = number(steps) + " steps per elastic period";
    if (elastic) {
        choice.reason = (event ? "without elasticity the peak would be off by " + percent(ignored)
                               : std::string("the event is not known")) +
                        "; " + period + " leave an error of " + percent(resolved);
    } else if (ignored <= p.tolerance) {
        choice.reason = "elasticity changes the peak by " + percent(ignored) + ", tolerable";
    } else {
        const S needed = std::max(p.steps_per_period, pi / std::sqrt(p.tolerance));
        choice.reason =
            (event
                 ? "elasticity would change the peak by " + percent(ignored)
                 : "the event is not known; elasticity stores up to " +
                       number(system.strength * system.strength / (2 * system.stiffness)) + " J") +
            ", but " + period + " do not resolve it; dt <= " + number(p.dt * steps / needed) +
            " s would";
    }
}

template <std::floating_point S>
std::array<AxisSystem<S>, 6> checked_axes(const JointDetailParameters<S>& p) {
    check::positive("JointDetail.dt", p.dt, "s");
    check::positive_or_infinite("JointDetail.lever", p.lever, "m");
    check::between("JointDetail.tolerance", p.tolerance, S(0), S(1), "");
    check::non_negative("JointDetail.margin", p.margin, "");
    if (!(p.steps_per_period >= 2)) {
        check::fail("JointDetail.steps_per_period", p.steps_per_period, "", ">= 2");
    }
    std::array<AxisSystem<S>, 6> axes;
    for (std::size_t i = 0; i < 6; ++i) {
        axes[i] = {p.mass[i], p.capacity.stiffness[i], p.capacity.capacity[i], p.limit[i]};
        const std::string name = "JointDetail." + std::string(joint_axis_names[i]);
        check::positive(name + ".mass", axes[i].mass, "kg or kg m^2");
        check::positive_or_infinite(name + ".stiffness", axes[i].stiffness, "N/m or N m/rad");
        check::positive_or_infinite(name + ".capacity", axes[i].strength, "N or N m");
        check::positive_or_infinite(name + ".limit", axes[i].limit, "m or rad");
        if (p.event[i]) check_event(*p.event[i]);
    }
    return axes;
}

} // namespace detail_choice

/// The least detail that keeps the errors within the tolerance, or the best there is.
/// @throws std::invalid_argument where a parameter is missing or out of range.
template <std::floating_point S>
[[nodiscard]] JointDetail<S> choose_detail(const JointDetailParameters<S>& p) {
    using namespace detail_choice;
    const auto systems = checked_axes(p);
    JointDetail<S> joint;
    S sum = 0;
    std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
    for (std::size_t i = 0; i < 6; ++i) {
        joint.axis[i].utilisation = utilisation(p, systems[i], i);
        if (!std::isinf(systems[i].stiffness)) {
            joint.axis[i].steps_per_period = 2 * std::numbers::pi_v<S> *
                                             std::sqrt(systems[i].mass / systems[i].stiffness) /
                                             p.dt;
        }
        sum += (1 + p.margin) * joint.axis[i].utilisation;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return joint.axis[a].utilisation < joint.axis[b].utilisation;
    });
    S lost = 0; // strength of the others that the rigid axes would have taken
    for (const std::size_t i : order) {
        AxisChoice<S>& axis = joint.axis[i];
        const S loaded = (1 + p.margin) * axis.utilisation;
        lost += loaded * loaded;
        if (sum <= 1) {
            axis.reason = "sees " + percent(axis.utilisation) +
                          " of its capacity, and all axes together do not yield";
        } else if (lost <= p.tolerance) {
            axis.reason = "sees " + percent(axis.utilisation) +
                          " of its capacity, too little to weaken the others";
        } else {
            choose_plastic(p, systems[i], p.event[i], axis);
        }
    }
    return joint;
}

} // namespace ductile
