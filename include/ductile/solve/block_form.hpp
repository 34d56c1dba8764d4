// SPDX-License-Identifier: MIT
//
// The form that belongs to a block's kind (block_view.hpp says what a form is).
#pragma once

#include "ductile/solve/block_view.hpp"
#include "ductile/solve/contact_form.hpp"
#include "ductile/solve/coulomb_form.hpp"
#include "ductile/solve/ellipsoid_form.hpp"
#include "ductile/solve/surface_form.hpp"

namespace ductile::solve {

/// What `call` of the block's form returns.
template <class Call>
decltype(auto) with_form(const BlockView& view, const Call& call) {
    switch (view.block.kind) {
        case BlockKind::contact:
            return view.tangent.coulomb ? call(CoulombForm()) : call(ContactForm());
        case BlockKind::surface:
            return call(SurfaceForm());
        default:
            return call(EllipsoidForm());
    }
}

} // namespace ductile::solve
