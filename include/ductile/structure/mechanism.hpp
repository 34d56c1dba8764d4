// SPDX-License-Identifier: MIT
//
// Whether a structure is a mechanism by count: 6 freedoms a body, less the axes that its joints
// hold, over those of one free body, or over none where the ground holds it. By count alone: what
// holds twice here may be missing there.
//
// Source: J. C. Maxwell (1864), Phil. Mag. 27, 294-299.
#pragma once

#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

namespace ductile {

/// What a joint does to body `a`.
struct Bond {
    enum class To {
        body,
        ground,
        unknown ///< nobody knows how that is held
    };
    std::size_t a = 0;
    To to = To::ground;
    std::size_t b = 0; ///< where it is to a body
    int held = 6;      ///< axes, 0 to 6
};

/// What is free in a structure.
struct Mechanism {
    std::size_t body = 0; ///< one of those that hang together
    int freedoms = 0;     ///< more than it may have, > 0

    bool operator==(const Mechanism&) const = default;
};

/// The first part that hangs together and is one by count; what hangs on something unknown is not.
[[nodiscard]] inline std::optional<Mechanism> find_mechanism(std::size_t bodies,
                                                             const std::vector<Bond>& bonds) {
    std::vector<std::size_t> parent(bodies);
    std::iota(parent.begin(), parent.end(), std::size_t(0));
    const auto root = [&parent](std::size_t i) {
        while (parent[i] != i) i = parent[i];
        return i;
    };
    for (const Bond& bond : bonds) {
        if (bond.to == Bond::To::body) parent[root(bond.a)] = root(bond.b);
    }
    std::vector<int> freedoms(bodies, 0), allowed(bodies, 6);
    std::vector<bool> unknown(bodies, false);
    for (std::size_t i = 0; i < bodies; ++i) freedoms[root(i)] += 6;
    for (const Bond& bond : bonds) {
        const std::size_t part = root(bond.a);
        freedoms[part] -= bond.held;
        if (bond.to == Bond::To::ground) allowed[part] = 0;
        if (bond.to == Bond::To::unknown) unknown[part] = true;
    }
    for (std::size_t i = 0; i < bodies; ++i) {
        const std::size_t part = root(i);
        if (!unknown[part] && freedoms[part] > allowed[part]) {
            return Mechanism{i, freedoms[part] - allowed[part]};
        }
    }
    return std::nullopt;
}

} // namespace ductile
