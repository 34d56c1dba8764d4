// SPDX-License-Identifier: MIT
//
// The three-storey frame of reference problem P29, and what stands on it. Included after a
// structure rig.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/structure/structure_model.hpp"

namespace ductile::test {

struct FrameSettings {
    bool elastic = true;
    double weights = 1;    ///< factor on gravity
    bool loose = false;    ///< on footings, 0.3 m high, 260 kg, that lie on the ground
    double footing = 0.6;  ///< their width and depth [m]
    int crates = 0;        ///< of 1 t on every beam
    int frames = 1;        ///< one on the other, jointed by their columns
    bool contacts = false; ///< members collide
    double wave_damping = 1e-4, bending_damping = 3e-6; ///< of elastic joints [s]
    engine::WorldParameters world{};
};

/// Such as "beam 13": storey 1, number 3; those of a second frame are "upper beam 13".
inline std::string member_name(const char* kind, int storey, int number) {
    return (storey < 3 ? "" : "upper ") + std::string(kind) + " " + std::to_string(storey % 3) +
           std::to_string(number);
}

/// The frames, from the nodes at their feet `base` [m] over the ground.
inline StructureModel frame_model(const FrameSettings& settings, double base) {
    const Material<double> steel(s355<double>());
    const ISection<double> heb(
        {.width = 0.2, .height = 0.2, .web_thickness = 0.009, .flange_thickness = 0.015});
    const ISection<double> ipe(
        {.width = 0.15, .height = 0.3, .web_thickness = 0.0071, .flange_thickness = 0.0107});
    const double x[] = {0, 6, 6, 0}, y[] = {0, 0, 5, 5};
    const int storeys = 3 * settings.frames;
    StructureModel model({.elastic = settings.elastic});
    std::vector<std::array<NodeId, 4>> at(std::size_t(storeys) + 1);
    for (int k = 0; k <= storeys; ++k) {
        for (int c = 0; c < 4; ++c) {
            at[std::size_t(k)][std::size_t(c)] = model.node({x[c], y[c], base + 3.5 * k});
        }
    }
    for (int k = 0; k < storeys; ++k) {
        const auto &below = at[std::size_t(k)], &above = at[std::size_t(k) + 1];
        for (std::size_t c = 0; c < 4; ++c) {
            model.member(member_name("column", k, int(c)), below[c], above[c], heb, steel,
                         {.joint_length = 0.2,
                          .mass_per_length = 61.3,
                          .wave_damping = settings.wave_damping,
                          .bending_damping = settings.bending_damping,
                          .gap = 0.01,
                          .collides = settings.contacts,
                          .box_inertia = true});
        }
    }
    for (int k = 0; k < storeys; ++k) {
        const auto& above = at[std::size_t(k) + 1];
        for (std::size_t b = 0; b < 4; ++b) {
            model.member(member_name("beam", k, int(b)), above[b], above[(b + 1) % 4], ipe, steel,
                         {.joint_length = 0.3,
                          .setback = 0.1,
                          .offset = {0, 0, -0.16},
                          .mass_per_length = 42.2,
                          .carried_mass = 3000,
                          .wave_damping = settings.wave_damping,
                          .bending_damping = settings.bending_damping,
                          .gap = 0.01,
                          .collides = settings.contacts || settings.crates > 0,
                          .box_inertia = true});
        }
    }
    for (const NodeId foot : at[0]) {
        if (settings.loose) {
            model.footing(
                foot,
                {.width = settings.footing, .depth = settings.footing, .height = 0.3, .mass = 260});
        } else {
            model.support(foot);
        }
    }
    return model;
}

/// The frame in an engine.
class Frame {
  public:
    explicit Frame(const FrameSettings& settings)
        : rig(9.81 * settings.weights, settings.world),
          structure(rig.build(frame_model(settings, settings.loose ? 0.3 - rig.layer : 0))) {
        for (int k = 0; k < 3 * settings.frames; ++k) {
            for (int b = 0; b < 4; ++b) beams.push_back(member_name("beam", k, b));
        }
        for (const std::string& beam : beams) {
            for (int crate = 0; crate < settings.crates; ++crate) {
                const PlanMember& of = structure->plan().members[structure->plan().member(beam)];
                const Vector3<double> along = (of.to - of.from).normalized();
                const double side = (crate - (settings.crates - 1) / 2.0) * 1.5;
                const Vector3<double> above(0, 0, 0.55 - rig.layer);
                rig.box(1000, {0.4, 0.4, 0.4}, (of.from + of.to) / 2 + side * along + above);
            }
        }
        rig.set_friction(0.6);
    }

    [[nodiscard]] double utilisation_of(const std::string& member, MemberEnd end) const {
        return structure->joint(member, end).utilisation();
    }
    /// Largest way of a beam along x or y from where it was made [m].
    [[nodiscard]] double sway() const {
        double most = 0;
        for (const std::string& beam : beams) {
            const Vector3<double> way = structure->displacement(beam);
            most = std::max({most, std::abs(way.x()), std::abs(way.y())});
        }
        return most;
    }

    StructureRig rig;
    std::unique_ptr<engine::Structure> structure;
    std::vector<std::string> beams;
};

} // namespace ductile::test
