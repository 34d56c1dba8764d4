// SPDX-License-Identifier: MIT
//
// Checks of parameters. Every failure is one line that names the field, the value, the unit and the
// allowed range, thrown as std::invalid_argument. Constructors call these; hot functions never do.
#pragma once

#include "ductile/vocabulary/build_check.hpp"

#include <cmath>
#include <concepts>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ductile::check {

/// @throws std::invalid_argument "field = value unit: must be range", without a trailing blank where
/// the unit is empty.
template <std::floating_point Scalar>
[[noreturn]] void fail(std::string_view field, Scalar value, std::string_view unit,
                       std::string_view range) {
    std::ostringstream message;
    message.precision(std::numeric_limits<Scalar>::digits10);
    message << field << " = " << value;
    if (!unit.empty()) message << ' ' << unit;
    message << ": must be " << range;
    throw std::invalid_argument(message.str());
}

/// Finite and greater than zero.
template <std::floating_point Scalar>
Scalar positive(std::string_view field, Scalar value, std::string_view unit) {
    if (!(value > 0) || !std::isfinite(value)) fail(field, value, unit, "finite and > 0");
    return value;
}

/// Finite and not negative.
template <std::floating_point Scalar>
Scalar non_negative(std::string_view field, Scalar value, std::string_view unit) {
    if (!(value >= 0) || !std::isfinite(value)) fail(field, value, unit, "finite and >= 0");
    return value;
}

/// Greater than zero; infinity is allowed and means "no limit".
template <std::floating_point Scalar>
Scalar positive_or_infinite(std::string_view field, Scalar value, std::string_view unit) {
    if (!(value > 0)) fail(field, value, unit, "> 0 (infinity: no limit)");
    return value;
}

/// lower < value < upper, or lower <= value <= upper where `closed`.
template <std::floating_point Scalar>
Scalar between(std::string_view field, Scalar value, Scalar lower, Scalar upper,
               std::string_view unit, bool closed = false) {
    const bool inside = closed ? (value >= lower && value <= upper) : (value > lower && value < upper);
    if (!inside) {
        std::ostringstream range;
        range.precision(std::numeric_limits<Scalar>::digits10);
        range << "in " << (closed ? '[' : '(') << lower << ", " << upper << (closed ? ']' : ')');
        if (!unit.empty()) range << ' ' << unit;
        fail(field, value, unit, range.str());
    }
    return value;
}

} // namespace ductile::check
