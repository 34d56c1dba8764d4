// SPDX-License-Identifier: MIT
//
// The form that belongs to a block's kind (block_view.hpp says what a form is).
#pragma once

#include "ductile/solve/block_view.hpp"
#include "ductile/solve/contact_form.hpp"
#include "ductile/solve/ellipsoid_form.hpp"

namespace ductile::solve {

/// What `call(EllipsoidForm())` or `call(ContactForm())` returns.
template <class Call>
decltype(auto) with_form(const BlockView& view, const Call& call) {
    return view.block.kind == BlockKind::contact ? call(ContactForm()) : call(EllipsoidForm());
}

} // namespace ductile::solve
