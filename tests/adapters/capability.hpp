// SPDX-License-Identifier: MIT
//
// What a solver of an engine can do. Tests ask for capabilities, never for a solver by name; where
// one is lacking they ask that the certificate says so.
#pragma once

#include <string>
#include <vector>

namespace ductile::test {

enum class Capability {
    coupled, ///< a few rows that hang together, to round-off
    chains,  ///< many coupled plastic hinges to round-off
    any_rows ///< rows of any compliance and of bounds that do not enclose zero
};

template <class Rig>
[[nodiscard]] std::vector<std::string> solvers_with(Capability capability) {
    std::vector<std::string> result;
    for (const std::string& solver : Rig::solvers()) {
        if (Rig::can(solver, capability)) result.push_back(solver);
    }
    return result;
}

} // namespace ductile::test
