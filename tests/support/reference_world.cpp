// SPDX-License-Identifier: MIT
//
// The reference integrator, compiled once for all tests.
#include "reference/world.hpp"

namespace ductile::reference {

template class BoxedLcp<double>;
template class World<double>;

} // namespace ductile::reference
