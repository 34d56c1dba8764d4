// SPDX-License-Identifier: MIT
//
// What an engine is to be told for a part of a frame, and for a blow.
//
//   ERP         what a part removes of the error of rigid rows: the world's share, or less where
//               the part is short, h/5 ms; a blow none. A share of each part would throw joints
//               about, as parts may be as short as 0.1 µs. Plastic joints that are far off are
//               closed more slowly (joint/any_link.ipp).
//   overlap     its share of what the frame would remove, but no more than that, and no faster than
//               a frame of 1/60 s does. Bodies have mass: pushed apart in 5 ms, 24 crates that lay
//               1.4 mm deep in their beams got 1.7 kJ, and a gate whose halves lay 0.1 m deep as
//               they parted took 183 and 238 kJ at 1/500 and 1/1000 s, where it takes 154.
//   springs     stops and suspensions that an engine has ERP and compliance of: those of a step of
//               the frame, so that stiffness and damping are the same in a part of any length
//   laws        a spring and a damper of which stiffness and damping are known are a row with the
//               mean of their forces at both ends of the part, which keeps what a spring holds at
//               any length; a force of the part's middle is that of a softer or harder spring in a
//               part of another length, which gave energy: 3 to 10^10 times what there was
//   compliance  of contacts and softened rows, which engines divide by the step: in a blow that of
//               a step of 0.1 ms, else 1 ns would meet a contact softer by 10⁵
#pragma once

#include <algorithm>

#include "ductile/vocabulary/damper_share.hpp"

namespace ductile {

/// Length that an engine is told of a blow, in which no time passes [s].
inline constexpr double blow_length = 1e-9;

/// ERP of a part of `h` [s] in a world of `usual` [-].
[[nodiscard]] inline double part_erp(double usual, double h) noexcept {
    constexpr double removed_in = 5e-3; // [s]
    return std::min(usual, h / removed_in);
}

/// The same of bodies that overlap, in a frame of `frame` [s].
[[nodiscard]] inline double overlap_erp(double usual, double h, double frame) noexcept {
    constexpr double slowly = 1.0 / 60; // [s]
    return std::min(usual * h / std::max(frame, slowly), part_erp(usual, h));
}

/// The same of a contact that would remove `usual` [-] of an `overlap` [m] in a step of `h` [s],
/// between bodies that a joint held until it broke. They may overlap then, by a half of a section
/// that bent, and pushed apart as others are would have 4 % of what that absorbed, more where they
/// are pressed: no faster than this, which makes good what a solver lets them sink.
[[nodiscard]] inline double parted_erp(double usual, double overlap, double h) noexcept {
    constexpr double speed = 1e-4; // [m/s]
    return overlap > 0 ? std::min(usual, speed * h / overlap) : usual;
}

struct Softness {
    double erp;        ///< [-]
    double compliance; ///< [s/kg | s/(kg m²)]
};

/// What has stiffness erp/(h compliance) and damping (1 - erp)/compliance of `usual` in a frame of
/// `frame` [s]; where it is hard it gives way no faster than a part does.
[[nodiscard]] inline Softness part_spring(const Softness& usual, double h, double frame) noexcept {
    const double share = usual.erp * h / frame, whole = 1 - usual.erp + share;
    if (!(whole > 0)) return {part_erp(usual.erp, h), usual.compliance};
    return {part_erp(share / whole, h), usual.compliance / whole};
}

/// u' + C λ = b of a row whose bodies are half a step ahead: C = `compliance` [1/kg | 1/(kg m²)], b
/// = `target` [m/s | rad/s].
struct LawRow {
    double target, compliance;
};

/// Of a spring k and a damper d beside it, whose strain x grows with the row's velocity u,
///
///   λ = -k h (x + h (u' - u)/4) - d h (θ u' + (1 - θ) u)
///
/// x in the middle of a part of `h` [s], u as it begins; θ: damper_share.hpp. k -> ∞: u' = u - 4
/// x/h. Not both are 0.
/// @param mass that the row feels [kg | kg m²]
[[nodiscard]] inline LawRow law_row(double stiffness, double damping, double mass, double strain,
                                    double velocity, double h) noexcept {
    const double damps = damping * h, springs = stiffness * h * h / 4;
    const double later = damper_share(damps, mass);
    const double own = springs + later * damps;
    const double before = (springs - (1 - later) * damps) * velocity;
    return {(before - stiffness * h * strain) / own, 1 / own};
}

/// Of a world's compliance in a blow of `h` [s], by which it has to be multiplied [-].
[[nodiscard]] inline double blow_compliance(double h) noexcept {
    constexpr double as_in = 1e-4; // [s]
    return h / as_in;
}

} // namespace ductile
