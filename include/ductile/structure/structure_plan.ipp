// SPDX-License-Identifier: MIT
//
// Bodies of structure_plan.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "ductile/structure/mechanism.hpp"
#include "ductile/structure/refuse.hpp"
#include "ductile/structure/structure_plan.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

DUCTILE_INLINE double StructurePlan::mass() const noexcept {
    double all = 0;
    for (const PlanBody& body : bodies) all += body.mass;
    return all;
}

DUCTILE_INLINE std::size_t StructurePlan::member(std::string_view name) const {
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (members[i].name == name) return i;
    }
    detail::refuse("Structure.member", std::string(name), "the name of a member");
}

DUCTILE_INLINE std::size_t StructurePlan::joint(std::string_view name, MemberEnd end) const {
    const PlanMember& of = members[member(name)];
    const bool start = end == MemberEnd::start;
    if (!(start ? of.start_jointed : of.end_jointed)) {
        detail::refuse("Structure.joint(" + of.name + ").end", start ? "start" : "end",
                       "a jointed end: this one carries its node");
    }
    return start ? of.first_joint : of.first_joint + of.joints - 1;
}

DUCTILE_INLINE std::size_t StructurePlan::joint(std::string_view name, std::size_t number) const {
    const PlanMember& of = members[member(name)];
    if (number >= of.joints) {
        detail::refuse("Structure.joint(" + of.name + ").number", std::to_string(number),
                       "less than " + std::to_string(of.joints));
    }
    return of.first_joint + number;
}

DUCTILE_INLINE std::size_t StructurePlan::body(std::string_view name, std::size_t piece) const {
    const PlanMember& of = members[member(name)];
    if (piece >= of.bodies) {
        detail::refuse("Structure.body(" + of.name + ").piece", std::to_string(piece),
                       "less than " + std::to_string(of.bodies));
    }
    return of.first_body + piece;
}

namespace detail {

/// Makes a plan, once.
class Planner {
  public:
    Planner(const StructureModel& model, std::span<const NodeId> own) : model_(model), own_(own) {}

    [[nodiscard]] StructurePlan plan() {
        if (model_.members().empty()) refuse("StructureModel.members", "none", "at least one");
        plan_.up = model_.parameters().up;
        gather_ends();
        for (std::size_t m = 0; m < model_.members().size(); ++m) add_pieces(m);
        for (std::size_t n = 0; n < ends_.size(); ++n) find_seat(n);
        for (std::size_t m = 0; m < model_.members().size(); ++m) add_joints(m);
        add_masses();
        for (std::size_t n = 0; n < ends_.size(); ++n) add_neighbours(n);
        if (!model_.parameters().mechanism) require_no_mechanism();
        return std::move(plan_);
    }

  private:
    using V3 = Vector3<double>;
    using M3 = Matrix3<double>;
    using Member = StructureModel::Member;

    struct EndOfMember {
        std::size_t member;
        bool start;
    };

    [[nodiscard]] const Member& member(std::size_t m) const { return model_.members()[m]; }
    [[nodiscard]] bool is_own(std::size_t n) const {
        return std::find(own_.begin(), own_.end(), NodeId{n}) != own_.end();
    }
    [[nodiscard]] bool carries(std::size_t m, bool start) const {
        const NodeId node = start ? member(m).start : member(m).end;
        const std::optional<EndOfMember>& by = carrier_[node.index];
        return by && by->member == m && by->start == start;
    }

    void gather_ends() {
        const auto& nodes = model_.nodes();
        ends_.resize(nodes.size());
        carrier_.resize(nodes.size());
        for (std::size_t m = 0; m < model_.members().size(); ++m) {
            ends_[member(m).start.index].push_back({m, true});
            ends_[member(m).end.index].push_back({m, false});
        }
        for (const NodeId node : own_) {
            if (node.index >= nodes.size()) {
                refuse("Structure.own.node", numbered("node", node.index),
                       "a node of the model, which has " + std::to_string(nodes.size()));
            }
        }
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            plan_.places.push_back(nodes[n].at);
            const std::string name = numbered("StructureModel.node", n);
            if (ends_[n].empty()) refuse(name, text(nodes[n].at), "an end of a member");
            const bool held = nodes[n].supported || nodes[n].footing.has_value();
            if (held && is_own(n)) {
                refuse("Structure.own.node", numbered("node", n), "one without a support");
            }
            if ((nodes[n].supported || is_own(n)) && nodes[n].mass > 0) {
                check::fail(name + ".mass", nodes[n].mass, "kg",
                            "0 where the node is the ground or a body of the user's");
            }
            if (held || is_own(n)) continue;
            carrier_[n] = *std::max_element(
                ends_[n].begin(), ends_[n].end(), [this](const auto& one, const auto& other) {
                    const double rank = rank_of(one), better = rank_of(other);
                    constexpr double round_off = 1e-6;
                    return better > rank + round_off;
                });
        }
    }

    /// Who carries a node: of those not freed there the steepest; -1 ... 1.
    [[nodiscard]] double rank_of(const EndOfMember& end) const {
        const MemberOptions& p = member(end.member).parameters;
        const auto& nodes = model_.nodes();
        const V3 way = difference(nodes[member(end.member).end.index].at,
                                  nodes[member(end.member).start.index].at);
        const double steep = std::abs(dot(plan_.up, way)) / norm(way);
        return (end.start ? p.free_at_start : p.free_at_end).empty() ? steep : steep - 2;
    }

    /// Columns: x, y of the section, z along the member.
    [[nodiscard]] M3 axes_of(const Member& of) const {
        const V3 up = model_.parameters().up;
        const V3 way = difference(plan_.places[of.end.index], plan_.places[of.start.index]);
        const V3 z = scaled(1 / norm(way), way);
        constexpr double upright = 1e-3;
        if (of.parameters.up) return axes_along(z, *of.parameters.up);
        return axes_along(z, norm(cross(up, z)) < upright ? level() : up);
    }
    /// A direction across the vertical.
    [[nodiscard]] V3 level() const {
        return std::abs(plan_.up.y()) < 0.5 ? V3(0, 1, 0) : V3(0, 0, 1);
    }
    /// z as given, y as near to `y` as it can be.
    [[nodiscard]] static M3 axes_along(const V3& z, const V3& y) {
        const V3 across = cross(y, z), x = scaled(1 / norm(across), across);
        M3 axes;
        axes.col(0) = x;
        axes.col(1) = cross(z, x);
        axes.col(2) = z;
        return axes;
    }

    void add_pieces(std::size_t m) {
        const Member& of = member(m);
        const MemberOptions& p = of.parameters;
        const MemberSection& s = of.section;
        const M3 axes = axes_of(of);
        const V3 start = plan_.places[of.start.index], end = plan_.places[of.end.index];
        const V3 back = scaled(p.setback, column(axes, 2));
        PlanMember found{.name = of.name,
                         .first_body = plan_.bodies.size(),
                         .bodies = std::size_t(p.pieces),
                         .first_joint = 0,
                         .joints = 0,
                         .start_jointed = !carries(m, true),
                         .end_jointed = !carries(m, false),
                         .from = sum(sum(start, p.offset), back),
                         .to = difference(sum(end, p.offset), back)};
        const auto stations =
            joint_stations(p.pieces, found.start_jointed, found.end_jointed, p.spacing);
        found.joints = stations.size();
        const double mass =
            p.mass_per_length.value_or(s.density * s.area) * norm(difference(end, start)) +
            p.carried_mass;
        const V3 way = difference(found.to, found.from);
        double from = 0;
        for (std::size_t i = 0; i < found.bodies; ++i) {
            const std::size_t next = found.start_jointed ? i + 1 : i;
            const double to = i + 1 < found.bodies ? stations[next].at : 1;
            const double length = (to - from) * norm(way);
            PlanBody body{
                .name = i > 0 ? numbered(of.name, i) : of.name,
                .mass = mass * (to - from),
                .pose = {sum(found.from, scaled((from + to) / 2, way)), axes},
                .box = {{(s.lowest_x + s.highest_x) / 2, (s.lowest_y + s.highest_y) / 2, 0},
                        M3::Identity()},
                .half_lengths = {(s.highest_x - s.lowest_x) / 2, (s.highest_y - s.lowest_y) / 2,
                                 length / 2 - p.gap},
                .collides = p.collides};
            tensors_.push_back(p.box_inertia ? box_inertia(body.mass, body.half_lengths)
                                             : bar_inertia(body.mass, length, s));
            plan_.bodies.push_back(std::move(body));
            from = to;
        }
        plan_.members.push_back(std::move(found));
    }

    void find_seat(std::size_t n) {
        const StructureModel::Node& node = model_.nodes()[n];
        if (is_own(n)) {
            plan_.seats.push_back({PlanSeat::Kind::own, n});
        } else if (node.supported) {
            plan_.seats.push_back({});
        } else if (node.footing) {
            plan_.seats.push_back({PlanSeat::Kind::body, plan_.bodies.size()});
            add_footing(n, *node.footing);
        } else {
            const PlanMember& by = plan_.members[carrier_[n]->member];
            const std::size_t piece = carrier_[n]->start ? 0 : by.bodies - 1;
            plan_.seats.push_back({PlanSeat::Kind::body, by.first_body + piece});
        }
    }

    void add_footing(std::size_t n, const FootingParameters& p) {
        const V3 up = plan_.up;
        PlanBody body{.name = numbered("footing", n),
                      .mass = p.mass,
                      .pose = {difference(plan_.places[n], scaled(p.height / 2, up)),
                               axes_along(up, level())},
                      .box = {},
                      .half_lengths = {p.width / 2, p.depth / 2, p.height / 2}};
        tensors_.push_back(box_inertia(body.mass, body.half_lengths));
        plan_.bodies.push_back(std::move(body));
    }

    void add_joints(std::size_t m) {
        const Member& of = member(m);
        const MemberOptions& p = of.parameters;
        PlanMember& found = plan_.members[m];
        found.first_joint = plan_.joints.size();
        const M3 axes = axes_of(of);
        const V3 way = difference(found.to, found.from);
        const auto stations =
            joint_stations(p.pieces, found.start_jointed, found.end_jointed, p.spacing);
        for (std::size_t i = 0; i < stations.size(); ++i) {
            const std::size_t inner = i + (found.start_jointed ? 0 : 1); // 0: the start
            const bool at_start = inner == 0, at_end = inner == found.bodies;
            const std::size_t first = found.first_body;
            const std::string where = at_start ? "start" : at_end ? "end" : std::to_string(inner);
            const double length = p.joint_length.value_or(stations[i].share * norm(way));
            static const std::vector<JointAxis> none;
            const auto& freed = at_start ? p.free_at_start : at_end ? p.free_at_end : none;
            plan_.joints.push_back({.name = of.name + " " + where,
                                    .member = m,
                                    .a = at_end ? first + found.bodies - 1 : first + inner,
                                    .b = at_start ? plan_.seats[of.start.index]
                                         : at_end
                                             ? plan_.seats[of.end.index]
                                             : PlanSeat{PlanSeat::Kind::body, first + inner - 1},
                                    .frame = {sum(found.from, scaled(stations[i].at, way)), axes},
                                    .length = length,
                                    .joint = joint_of(of, length, freed)});
            bonds_.push_back(bond_of(plan_.joints.back(), freed));
        }
    }

    [[nodiscard]] static Bond bond_of(const PlanJoint& joint, const std::vector<JointAxis>& freed) {
        Bond bond{.a = joint.a, .b = joint.b.index, .held = 0};
        for (const JointAxis axis : all_joint_axes) {
            bond.held += std::find(freed.begin(), freed.end(), axis) == freed.end() ? 1 : 0;
        }
        switch (joint.b.kind) {
            case PlanSeat::Kind::ground:
                bond.to = Bond::To::ground;
                break;
            case PlanSeat::Kind::body:
                bond.to = Bond::To::body;
                break;
            case PlanSeat::Kind::own:
                bond.to = Bond::To::unknown;
                break;
        }
        return bond;
    }

    [[nodiscard]] SectionJoint<double> joint_of(const Member& of, double length,
                                                const std::vector<JointAxis>& freed) const {
        const MemberOptions& p = of.parameters;
        const auto joint = of.section.joint({.length = length,
                                             .largest_bending = p.largest_bending,
                                             .largest_twist = p.largest_twist,
                                             .elastic = model_.parameters().elastic,
                                             .wave_damping = p.wave_damping,
                                             .bending_damping = p.bending_damping});
        if (freed.empty()) return joint;
        constexpr double left = 1e-9; // of the stiffness: a row needs some
        auto rows = joint.parameters();
        for (const JointAxis axis : freed) {
            const auto row = Eigen::Index(index(axis));
            rows.section_stiffness[row] *= left;
            rows.stiffness[row] = rows.section_stiffness[row];
        }
        return SectionJoint<double>(joint.surface(), joint.law(), joint.criterion(), rows);
    }

    /// Of nodes, and the bodies' principal axes.
    void add_masses() {
        for (std::size_t n = 0; n < ends_.size(); ++n) {
            const double mass = model_.nodes()[n].mass;
            if (!(mass > 0)) continue;
            const std::size_t b = plan_.seats[n].index;
            PlanBody& body = plan_.bodies[b];
            const V3 arm =
                transposed_times(body.pose.axes, difference(plan_.places[n], body.pose.origin));
            const double all = body.mass + mass, reduced = body.mass * mass / all;
            const M3 across = skew(arm);
            tensors_[b] = difference(tensors_[b], scaled(reduced, times(across, across)));
            const V3 shift = scaled(mass / all, arm);
            body.box.origin = difference(body.box.origin, shift);
            body.pose.origin = sum(body.pose.origin, times(body.pose.axes, shift));
            body.mass = all;
        }
        for (std::size_t b = 0; b < plan_.bodies.size(); ++b) {
            turn_to_principal(plan_.bodies[b], tensors_[b]);
        }
    }

    [[nodiscard]] bool jointed(std::size_t a, std::size_t b) const {
        return std::any_of(plan_.joints.begin(), plan_.joints.end(), [&](const PlanJoint& joint) {
            if (joint.b.kind != PlanSeat::Kind::body) return false;
            return (joint.a == a && joint.b.index == b) || (joint.a == b && joint.b.index == a);
        });
    }
    void add_neighbours(std::size_t n) {
        std::vector<std::size_t> here;
        for (const EndOfMember& end : ends_[n]) {
            const PlanMember& of = plan_.members[end.member];
            here.push_back(of.first_body + (end.start ? 0 : of.bodies - 1));
        }
        if (model_.nodes()[n].footing) here.push_back(plan_.seats[n].index);
        for (std::size_t i = 0; i < here.size(); ++i) {
            for (std::size_t k = i + 1; k < here.size(); ++k) {
                if (here[i] == here[k] || jointed(here[i], here[k])) continue;
                plan_.neighbours.emplace_back(here[i], here[k]);
            }
        }
    }

    void require_no_mechanism() const {
        const auto found = find_mechanism(plan_.bodies.size(), bonds_);
        if (!found) return;
        refuse("StructureModel.mechanism", "false",
               "true where parts move freely: of " + plan_.bodies[found->body].name +
                   " and what hangs together with it no joint holds " +
                   std::to_string(found->freedoms) + " of the freedoms");
    }

    const StructureModel& model_;
    std::span<const NodeId> own_;
    StructurePlan plan_;
    std::vector<std::vector<EndOfMember>> ends_;      ///< by node
    std::vector<std::optional<EndOfMember>> carrier_; ///< by node
    std::vector<M3> tensors_;                         ///< by body, in its axes
    std::vector<Bond> bonds_;                         ///< by joint
};

} // namespace detail

DUCTILE_INLINE StructurePlan make_plan(const StructureModel& model, std::span<const NodeId> own) {
    return detail::Planner(model, own).plan();
}

} // namespace ductile
