// SPDX-License-Identifier: MIT
//
// Numbers in messages, as a stream writes them by default, without the cost of compiling one.
#pragma once

#include <cstdio>
#include <string>

namespace ductile {

/// `value` to `digits` significant digits, 1 to 40 of them: "0.001", "1e+06", "inf", "nan".
[[nodiscard]] inline std::string number_text(long double value, int digits) {
    char text[64]; // sign, digits, point, exponent
    std::snprintf(text, sizeof text, "%.*Lg", digits, value);
    return text;
}

} // namespace ductile
