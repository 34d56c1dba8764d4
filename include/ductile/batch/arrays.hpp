// SPDX-License-Identifier: MIT
//
// The arrays of a batch: one span per number, entry i belongs to joint i. The caller owns the
// memory and hands in the same arrays every step; the engine writes `motion` and `reaction` and
// reads `rows`. No two spans may overlap where one of them is written, because the loops run over
// several joints at once.
//
// Symbols as in joint/one_axis_joint.hpp.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ductile/batch/status.hpp"

namespace ductile {

/// Written by the engine before the step.
template <std::floating_point S>
struct BatchMotion {
    std::span<const S> position{}; ///< q, not wrapped [m | rad]
    std::span<const S> velocity{}; ///< u before this step's external impulses [m/s | rad/s]
};

/// Written by prepare, read by the engine and again by commit.
template <std::floating_point S>
struct BatchRows {
    std::span<S> lower{}; ///< smallest force [N | N m]
    std::span<S> upper{}; ///< largest force [N | N m]
    std::span<S> bias{};  ///< target velocity b [m/s | rad/s]
};

/// Written by the engine after the solve. May be the arrays of BatchMotion.
template <std::floating_point S>
struct BatchReaction {
    std::span<const S> force{};    ///< λ/dt [N | N m]
    std::span<const S> velocity{}; ///< u' [m/s | rad/s]
    std::span<const S> position{}; ///< q after the engine moved the bodies, not wrapped [m | rad]
};

/// What the joints remember; all zero for new ones. The fields of OneAxisState, its two flags in
/// `status`. Between prepare and commit `start_velocity` holds u of the step under way.
template <std::floating_point S>
struct BatchState {
    std::span<S> plastic_offset{}; ///< q_p [m | rad]
    std::span<S> plastic_travel{}; ///< p, never decreases [m | rad]
    std::span<S> plastic_work{};   ///< D, never decreases [J]
    std::span<S> other_work{};     ///< either sign [J]
    std::span<S> start_velocity{}; ///< u of the last step [m/s | rad/s]
    std::span<S> velocity{};       ///< u' of the last step [m/s | rad/s]
    std::span<S> residual_max{};   ///< [m/s | rad/s]
    std::span<BatchStatus> status{};
};

/// Written by commit. The outcome is in BatchState::status.
template <std::floating_point S>
struct BatchStep {
    std::span<S> release{}; ///< taken in excess by a breaking step, to be handed back, >= 0 [J]
    /// Violation of the row's complementarity, >= 0; infinite: an input was not finite, and of the
    /// step nothing but `start_velocity` was written [m/s | rad/s].
    std::span<S> residual{};
};

template <std::floating_point S>
struct BatchArrays {
    BatchMotion<S> motion{};
    BatchRows<S> rows{};
    BatchReaction<S> reaction{};
    BatchState<S> state{};
    BatchStep<S> step{};
};

namespace batch_detail {

struct NamedBytes {
    std::string_view name;
    std::uintptr_t begin = 0;
    std::size_t size = 0; ///< entries
    std::size_t bytes = 0;
    bool written = false;
};

template <class T>
NamedBytes named(std::string_view name, std::span<T> span) noexcept {
    return {name, reinterpret_cast<std::uintptr_t>(span.data()), span.size(), span.size_bytes(),
            !std::is_const_v<T>};
}

template <std::floating_point S>
std::array<NamedBytes, 18> all_spans(const BatchArrays<S>& a) noexcept {
    return {named("motion.position", a.motion.position),
            named("motion.velocity", a.motion.velocity),
            named("reaction.force", a.reaction.force),
            named("reaction.velocity", a.reaction.velocity),
            named("reaction.position", a.reaction.position),
            named("rows.lower", a.rows.lower),
            named("rows.upper", a.rows.upper),
            named("rows.bias", a.rows.bias),
            named("state.plastic_offset", a.state.plastic_offset),
            named("state.plastic_travel", a.state.plastic_travel),
            named("state.plastic_work", a.state.plastic_work),
            named("state.other_work", a.state.other_work),
            named("state.start_velocity", a.state.start_velocity),
            named("state.velocity", a.state.velocity),
            named("state.residual_max", a.state.residual_max),
            named("state.status", a.state.status),
            named("step.release", a.step.release),
            named("step.residual", a.step.residual)};
}

inline void check_size(const NamedBytes& span, std::size_t joints) {
    if (span.size != joints) {
        throw std::invalid_argument("OneAxisBatch." + std::string(span.name) +
                                    ".size() = " + std::to_string(span.size) + ": must be " +
                                    std::to_string(joints) + ", as motion.position.size()");
    }
}

inline void check_apart(const NamedBytes& a, const NamedBytes& b) {
    const bool overlap = a.begin < b.begin + b.bytes && b.begin < a.begin + a.bytes;
    if ((a.written || b.written) && overlap) {
        throw std::invalid_argument("OneAxisBatch." + std::string(a.name) + " overlaps " +
                                    std::string(b.name) + ": must be memory of its own");
    }
}

} // namespace batch_detail

/// @throws std::invalid_argument where the sizes differ or a span that is written overlaps another.
template <std::floating_point S>
void check_arrays(const BatchArrays<S>& arrays) {
    const auto spans = batch_detail::all_spans(arrays);
    for (const auto& span : spans) batch_detail::check_size(span, arrays.motion.position.size());
    for (std::size_t i = 0; i < spans.size(); ++i) {
        for (std::size_t j = i + 1; j < spans.size(); ++j) {
            batch_detail::check_apart(spans[i], spans[j]);
        }
    }
}

} // namespace ductile
