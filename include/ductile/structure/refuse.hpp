// SPDX-License-Identifier: MIT
//
// Refusals of what is no number, in the words of vocabulary/check.hpp.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "ductile/vocabulary/check.hpp"
#include "ductile/vocabulary/number_text.hpp"
#include "ductile/vocabulary/vector.hpp"

namespace ductile::detail {

[[nodiscard]] inline std::string text(const Vector3<double>& v) {
    std::string result = "(";
    for (int i = 0; i < 3; ++i) {
        result.append(i > 0 ? ", " : "").append(number_text(v[i], 15));
    }
    return result.append(")");
}

/// Such as "node 3".
[[nodiscard]] inline std::string numbered(std::string what, std::size_t number) {
    return what.append(" ").append(std::to_string(number));
}

[[noreturn]] inline void refuse(const std::string& field, const std::string& value,
                                const std::string& range) {
    throw std::invalid_argument(field + " = " + value + ": must be " + range);
}

/// Finite and of a size within check::reach, and not zero where that is asked for.
inline void require_vector(const std::string& field, const Vector3<double>& v, bool has_direction) {
    if (!is_finite(v) || (has_direction && is_zero(v))) {
        refuse(field, text(v), has_direction ? "finite and not zero" : "finite");
    }
    constexpr double most = check::reach<double>;
    const double size = v.cwiseAbs().maxCoeff();
    if (size > most) refuse(field, text(v), "at most " + number_text(most, 3) + " in size");
    if (has_direction && size < 1 / most) {
        refuse(field, text(v), "at least " + number_text(1 / most, 3) + " in size");
    }
}

} // namespace ductile::detail
