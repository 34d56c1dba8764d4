// SPDX-License-Identifier: MIT
//
// What a solver of an engine can do. Tests ask for capabilities, never for a solver by name; where
// one is lacking they ask that the certificate says so.
#pragma once

namespace ductile::test {

enum class Capability {
    coupled, ///< a few rows that hang together, to round-off
    chains,  ///< many coupled plastic hinges to round-off
};

} // namespace ductile::test
