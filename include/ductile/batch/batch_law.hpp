// SPDX-License-Identifier: MIT
//
// The parameters of a batch: strength R(p) = R0 + H p with travel limit p_max, where each of the
// three is one number for all joints or an array with one per joint. Numbers that joints share
// should be shared here too: an array costs its bytes twice a step.
//
//   BatchLaw{Perfect, TravelLimit}             all joints alike
//   BatchLaw{Linear, TravelLimit}
//   BatchLaw(PerJoint R0, Shared H, Shared p_max)    any mixture
//
// Limit cases: H = 0 perfect plasticity; p_max = ∞ never breaks.
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ductile/fracture/travel_limit.hpp"
#include "ductile/law/linear.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

/// One number for every joint.
template <std::floating_point S>
struct Shared {
    using Scalar = S;
    S value;

    [[nodiscard]] S operator[](std::size_t /*joint*/) const noexcept { return value; }
};

/// A number for each joint; the memory is the caller's.
template <std::floating_point S>
struct PerJoint {
    using Scalar = S;
    std::span<const S> values;

    [[nodiscard]] S operator[](std::size_t joint) const noexcept { return values[joint]; }
};

/// Shared or PerJoint: `parameter[i]` is the number of joint i.
template <class T>
concept BatchParameter =
    std::same_as<T, Shared<typename T::Scalar>> || std::same_as<T, PerJoint<typename T::Scalar>>;

/// Immutable view.
template <BatchParameter Strength, BatchParameter Hardening = Shared<typename Strength::Scalar>,
          BatchParameter Limit = Shared<typename Strength::Scalar>>
requires std::same_as<typename Strength::Scalar, typename Hardening::Scalar> &&
    std::same_as<typename Strength::Scalar, typename Limit::Scalar>
class BatchLaw {
  public:
    using Scalar = typename Strength::Scalar;

    /// R0 [N | N m] > 0, H [N/m | N m/rad] >= 0, p_max [m | rad] > 0.
    /// @throws std::invalid_argument naming the first entry out of range. O(number of entries).
    explicit BatchLaw(Strength strength, Hardening hardening = {0},
                      Limit limit = {std::numeric_limits<Scalar>::infinity()})
        : strength_(strength), hardening_(hardening), limit_(limit) {
        each(strength, "BatchLaw.strength", [](std::string_view field, Scalar value) {
            check::positive(field, value, "N or N m");
        });
        each(hardening, "BatchLaw.hardening", [](std::string_view field, Scalar value) {
            check::non_negative(field, value, "N/m or N m/rad");
        });
        each(limit, "BatchLaw.limit", [](std::string_view field, Scalar value) {
            check::positive_or_infinite(field, value, "m or rad");
        });
    }

    [[nodiscard]] const Strength& strength() const noexcept { return strength_; }
    [[nodiscard]] const Hardening& hardening() const noexcept { return hardening_; }
    [[nodiscard]] const Limit& limit() const noexcept { return limit_; }

    /// @throws std::invalid_argument where an array has another length than `joints`.
    void check_size(std::size_t joints) const {
        check_size(strength_, "strength", joints);
        check_size(hardening_, "hardening", joints);
        check_size(limit_, "limit", joints);
    }

  private:
    template <class Check>
    static void each(const Shared<Scalar>& parameter, std::string_view field, Check check) {
        check(field, parameter.value);
    }
    template <class Check>
    static void each(const PerJoint<Scalar>& parameter, std::string_view field, Check check) {
        for (std::size_t i = 0; i < parameter.values.size(); ++i) {
            check(std::string(field) + "[" + std::to_string(i) + "]", parameter.values[i]);
        }
    }

    static void check_size(const Shared<Scalar>&, std::string_view, std::size_t) noexcept {}
    static void check_size(const PerJoint<Scalar>& parameter, std::string_view field,
                           std::size_t joints) {
        if (parameter.values.size() != joints) {
            throw std::invalid_argument("BatchLaw." + std::string(field) + ".size() = " +
                                        std::to_string(parameter.values.size()) + ": must be " +
                                        std::to_string(joints) + ", as motion.position.size()");
        }
    }

    Strength strength_;
    Hardening hardening_;
    Limit limit_;
};

/// All joints alike, as the scalar joint with the same parts.
template <std::floating_point S>
[[nodiscard]] BatchLaw<Shared<S>> batch_law(const Perfect<S>& law,
                                            const TravelLimit<S>& limit = {}) {
    return BatchLaw<Shared<S>>({law.value(0)}, {0}, {limit.limit()});
}
template <std::floating_point S>
[[nodiscard]] BatchLaw<Shared<S>> batch_law(const Linear<S>& law,
                                            const TravelLimit<S>& limit = {}) {
    return BatchLaw<Shared<S>>({law.value(0)}, {law.slope(0)}, {limit.limit()});
}

} // namespace ductile
