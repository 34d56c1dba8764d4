// SPDX-License-Identifier: MIT
//
// Checks of parameters. Every failure is one line that names the field, the value, the unit and the
// allowed range, thrown as std::invalid_argument. Constructors call these; hot functions never do.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ductile/vocabulary/build_check.hpp"
#include "ductile/vocabulary/number_text.hpp"

namespace ductile::check {

/// @throws std::invalid_argument "field = value unit: must be range", without a trailing blank
/// where the unit is empty.
template <std::floating_point Scalar>
[[noreturn]] void fail(std::string_view field, Scalar value, std::string_view unit,
                       std::string_view range) {
    std::string message(field);
    message.append(" = ").append(number_text(value, std::numeric_limits<Scalar>::digits10));
    if (!unit.empty()) message.append(" ").append(unit);
    throw std::invalid_argument(message.append(": must be ").append(range));
}

/// The largest size that a quantity may have, and one over the smallest: in double its square is a
/// number too, in float joints say where a product is none.
template <std::floating_point Scalar>
inline constexpr auto reach = Scalar(std::numeric_limits<Scalar>::digits10 > 10 ? 1e100 : 1e30);

/// Finite, and no larger than `reach`.
template <std::floating_point Scalar>
Scalar finite(std::string_view field, Scalar value, std::string_view unit) {
    if (!std::isfinite(value)) fail(field, value, unit, "finite");
    const Scalar most = reach<Scalar>;
    if (std::abs(value) > most) {
        fail(field, value, unit, "at most " + number_text(most, 3) + " in size");
    }
    return value;
}

/// Finite and not negative.
template <std::floating_point Scalar>
Scalar non_negative(std::string_view field, Scalar value, std::string_view unit) {
    if (!(value >= 0) || !std::isfinite(value)) fail(field, value, unit, "finite and >= 0");
    return finite(field, value, unit);
}

/// Finite and greater than zero.
template <std::floating_point Scalar>
Scalar positive(std::string_view field, Scalar value, std::string_view unit) {
    if (!(value > 0) || !std::isfinite(value)) fail(field, value, unit, "finite and > 0");
    const Scalar least = 1 / reach<Scalar>;
    if (value < least) fail(field, value, unit, "at least " + number_text(least, 3));
    return finite(field, value, unit);
}

/// Greater than zero; infinity is allowed and means "no limit".
template <std::floating_point Scalar>
Scalar positive_or_infinite(std::string_view field, Scalar value, std::string_view unit) {
    if (!(value > 0)) fail(field, value, unit, "> 0 (infinity: no limit)");
    return std::isinf(value) ? value : positive(field, value, unit);
}

/// lower < value < upper, or lower <= value <= upper where `closed`.
template <std::floating_point Scalar>
Scalar between(std::string_view field, Scalar value, Scalar lower, Scalar upper,
               std::string_view unit, bool closed = false) {
    const bool inside =
        closed ? (value >= lower && value <= upper) : (value > lower && value < upper);
    if (!inside) {
        constexpr int digits = std::numeric_limits<Scalar>::digits10;
        std::string range(closed ? "in [" : "in (");
        range.append(number_text(lower, digits)).append(", ").append(number_text(upper, digits));
        range.append(closed ? "]" : ")");
        if (!unit.empty()) range.append(" ").append(unit);
        fail(field, value, unit, range);
    }
    return value;
}

/// What a beam can be: longer than 1 km, or 25 m² of steel across, it is one described in
/// millimetres; `owner` has the fields `length` [m] and `mass_per_length` [kg/m].
inline void size_of_beam(const std::string& owner, double length, double mass_per_length) {
    constexpr double longest = 1000, heaviest = 2e5;
    positive(owner + ".length", length, "m");
    if (length > longest) {
        fail(owner + ".length", length, "m", "in (0, 1000] m: lengths are metres");
    }
    positive(owner + ".mass_per_length", mass_per_length, "kg/m");
    if (mass_per_length > heaviest) {
        fail(owner + ".mass_per_length", mass_per_length, "kg/m",
             "in (0, 200000] kg/m: a section's dimensions are metres");
    }
}

} // namespace ductile::check
