// SPDX-License-Identifier: MIT
//
// The reference integrator, compiled once for all tests.
#include "reference/pair_world.hpp"
#include "reference/world.hpp"

namespace ductile::reference {

template class BoxedLcp<double>;
template class World<double>;
template class BodyPair<double>;

} // namespace ductile::reference
