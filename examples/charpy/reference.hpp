// SPDX-License-Identifier: MIT
//
// What the test must give, by mechanics: the specimen as two rigid halves on frictionless sharp anvil
// edges, joined by a plastic hinge at mid-depth, pushed by a flat nose; one degree of freedom.
//
// Symbols
//   φ    half of the hinge angle θ = 2 φ                      [rad]
//   a    half the anvil gap; w half the nose flat; l, h specimen length and height     [m]
//   d(φ) = a tan φ - (h/2)(sec φ - 1)        travel of the hinge                    [m]
//   D(φ) = (a - w) tan φ - h (sec φ - 1)     travel of the nose                     [m]
//   k    bending stiffness of the joint, infinite but for the elastic-plastic methods   [N m/rad]
//   M    mass of the nose, hammer inertia / radius²                                  [kg]
//   M_s(φ) inertia of both halves as they turn: kinetic energy M_s φ'²/2             [kg m²]
//
// The halves slip through when a lower end corner reaches the anvil edge,
//   (l/2) cos φ + (h/2) sin φ = a,   φ = atan(h/l) + acos(2a/√(l² + h²)).
// First contact is perfectly inelastic (a restitution lets the halves run ahead of the nose and be caught again:
// small ones change little, which the tests bound), and then (M D'² + M_s) φ'²/2 + M_p 2φ is constant. An elastic
// joint has turned by M_p/k of the hinge angle without flow: it dissipates M_p (2φ - M_p/k), and
// M_p²/2k springs back once the halves are free. That is the mechanism of two parts; the elastic
// bend of further joints between more parts is left out.
#pragma once

#include <algorithm>
#include <cmath>

#include "scenario.hpp"

namespace charpy {

struct Reference {
    double rotation = 0;         ///< hinge angle when the specimen passes or breaks [rad]
    double plastic_work = 0;     ///< M_p × plastic part of the rotation [J]
    double stored = 0;           ///< elastic, at that rotation [J]
    double strike_energy = 0;    ///< of the hammer before contact [J]
    double strike_speed = 0;     ///< of the nose before contact [m/s]
    double contact_loss = 0;     ///< of the perfectly inelastic first contact [J]
    double hammer_loss = 0;      ///< kinetic energy the hammer loses until then [J]
    double specimen_kinetic = 0; ///< of the halves then [J]
    double rebound_loss = 0;     ///< of the hammer at a bar that does not bend: it keeps -e of its speed [J]
};

[[nodiscard]] inline Reference reference(const Scenario& s,
                                        Method method = Method::plastic_hinge) {
    const double a = s.anvil_gap / 2, w = s.flat() / 2, l = s.length, h = s.height;
    const double half_mass = s.specimen_mass() / 2;
    const double half_inertia = half_mass * (l * l / 4 + h * h) / 12;
    const double nose_mass = s.hammer_inertia() / (s.swing_radius * s.swing_radius);
    const auto nose_rate = [&](double phi) {
        return ((a - w) - h * std::sin(phi)) / (std::cos(phi) * std::cos(phi));
    };
    const auto specimen_inertia = [&](double phi) {
        const double c = std::cos(phi), sn = std::sin(phi);
        const double hinge_rate = (a - h / 2 * sn) / (c * c);
        const double x = hinge_rate - l / 4 * c, z = l / 4 * sn;
        return 2 * (half_mass * (x * x + z * z) + half_inertia);
    };
    const auto inertia = [&](double phi) {
        return nose_mass * nose_rate(phi) * nose_rate(phi) + specimen_inertia(phi);
    };

    Reference r;
    const double moment = s.notched_moment();
    const double elastic = is_elastic(method) ? moment / s.notched_stiffness() : 0;
    const double plastic = std::min(s.pass_rotation() - elastic, s.max_plastic_rotation);
    r.rotation = elastic + plastic;
    r.plastic_work = moment * plastic;
    r.stored = moment * elastic / 2;
    const double dropped = s.strike_energy();
    r.strike_energy = dropped;
    r.strike_speed = s.swing_radius * std::sqrt(2 * dropped / s.hammer_inertia());

    r.rebound_loss = dropped * (1 - s.restitution * s.restitution);

    const double momentum = nose_mass * nose_rate(0) * r.strike_speed;
    const double after_contact = momentum * momentum / inertia(0) / 2;
    r.contact_loss = dropped - after_contact;
    const double left = std::max(after_contact - r.plastic_work - r.stored, 0.0);
    const double phi = r.rotation / 2;
    r.specimen_kinetic = left * specimen_inertia(phi) / inertia(phi);
    r.hammer_loss = dropped - (left - r.specimen_kinetic);
    return r;
}

} // namespace charpy
