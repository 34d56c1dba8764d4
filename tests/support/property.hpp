// SPDX-License-Identifier: MIT
//
// Properties for rapidcheck behind one type: what rc::prop makes of a property is compiled once in
// a unit, not once for each property of each surface.
#pragma once

#include <rapidcheck/catch.h>

#include <functional>
#include <string>

namespace ductile::test {

/// As rc::prop, of a property without arguments.
inline void prop(const std::string& description, const std::function<void()>& property) {
    rc::prop(description, property);
}

} // namespace ductile::test
