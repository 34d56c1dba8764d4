// SPDX-License-Identifier: MIT
//
// Names the precision of this compiled library, so that a program of the other one does not link.
#include <ductile/bullet/precision_check.hpp>

namespace ductile::bullet {

#ifdef BT_USE_DOUBLE_PRECISION
void link_with_ductile_compiled_for_double_precision() {}
#else
void link_with_ductile_compiled_for_single_precision() {}
#endif

} // namespace ductile::bullet
