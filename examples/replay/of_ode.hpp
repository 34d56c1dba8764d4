// SPDX-License-Identifier: MIT
//
// ODE's bodies with their geoms, and plastic joints, for a recorder. A box, sphere, cylinder,
// capsule (as its cylinder and balls) and plane are drawn as they are, another geom not at all.
#pragma once

#include <ode/ode.h>

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/ode/ode.hpp"
#include "recorder.hpp"

namespace ductile::replay {

namespace detail {

[[nodiscard]] inline Pose pose_of(const dReal* position, const dReal* turn) {
    return {{position[0], position[1], position[2]}, {turn[0], turn[1], turn[2], turn[3]}};
}

inline void add_geom(Body& body, dGeomID geom, const Pose& at) {
    dReal radius = 0, length = 0;
    const auto add = [&](ShapeKind kind, double x, double y, double z) {
        body.shapes.push_back({kind, {x, y, z}, at});
    };
    switch (dGeomGetClass(geom)) {
        case dBoxClass: {
            dVector3 sides;
            dGeomBoxGetLengths(geom, sides);
            add(ShapeKind::box, sides[0] / 2, sides[1] / 2, sides[2] / 2);
            return;
        }
        case dSphereClass:
            add(ShapeKind::sphere, dGeomSphereGetRadius(geom), 0, 0);
            return;
        case dCylinderClass:
            dGeomCylinderGetParams(geom, &radius, &length);
            add(ShapeKind::cylinder, radius, length / 2, 0);
            return;
        case dCapsuleClass: {
            dGeomCapsuleGetParams(geom, &radius, &length);
            add(ShapeKind::cylinder, radius, length / 2, 0);
            dMatrix3 axes;
            const dQuaternion turn{at.turn[0], at.turn[1], at.turn[2], at.turn[3]};
            dRfromQ(axes, turn);
            for (const double side : {-1.0, 1.0}) {
                Pose end = at;
                for (std::size_t k = 0; k < 3; ++k) {
                    end.position[k] += side * length / 2 * axes[4 * k + 2];
                }
                body.shapes.push_back({ShapeKind::sphere, {radius, 0, 0}, end});
            }
            return;
        }
        default:
            return;
    }
}

} // namespace detail

/// All geoms of a body, which must live until it is removed from the recorder, or the recording is
/// finished.
inline void add_body(Recorder& recorder, dBodyID body, std::string name) {
    Body drawn{.name = std::move(name), .shapes = {}, .moves = true};
    for (dGeomID geom = dBodyGetFirstGeom(body); geom != nullptr; geom = dBodyGetNextGeom(geom)) {
        Pose at;
        if (dGeomIsOffset(geom) != 0) {
            dQuaternion turn;
            dGeomGetOffsetQuaternion(geom, turn);
            at = detail::pose_of(dGeomGetOffsetPosition(geom), turn);
        }
        detail::add_geom(drawn, geom, at);
    }
    recorder.add(body, std::move(drawn), [body] {
        return detail::pose_of(dBodyGetPosition(body), dBodyGetQuaternion(body));
    });
}

/// A geom of the static world.
inline void add_ground(Recorder& recorder, dGeomID geom, std::string name) {
    Body drawn{.name = std::move(name), .shapes = {}, .moves = false};
    Pose pose;
    if (dGeomGetClass(geom) == dPlaneClass) {
        constexpr double half = 50; // that is drawn [m]
        dVector4 plane;
        dGeomPlaneGetParams(geom, plane);
        dVector3 x, y;
        const dVector3 normal{plane[0], plane[1], plane[2]};
        dPlaneSpace(normal, x, y);
        const dMatrix3 axes{x[0],      y[0], normal[0], 0,    x[1],      y[1],
                            normal[1], 0,    x[2],      y[2], normal[2], 0};
        dQuaternion turn;
        dQfromR(turn, axes);
        const dVector3 place{plane[0] * plane[3], plane[1] * plane[3], plane[2] * plane[3]};
        pose = detail::pose_of(place, turn);
        drawn.shapes.push_back({ShapeKind::plane, {half, half, 0}, {}});
    } else {
        dQuaternion turn;
        dGeomGetQuaternion(geom, turn);
        pose = detail::pose_of(dGeomGetPosition(geom), turn);
        detail::add_geom(drawn, geom, {});
    }
    recorder.add(geom, std::move(drawn), [pose] { return pose; });
}

/// The joint must live as long, and be in the World by this name. Facts and life used:
/// joint_facts.hpp.
/// @param place  where it is, world [m]; ODE does not tell it of all joints
inline void add_joint(Recorder& recorder, const ode::PlasticConstraint& joint, std::string name,
                      const std::array<double, 3>& place, std::vector<Fact> facts = {},
                      std::function<double()> life = {}) {
    const ode::AttachedBodies bodies = joint.bodies();
    dVector3 in_a{};
    dBodyGetPosRelPoint(bodies.a, place[0], place[1], place[2], in_a);
    recorder.add({.name = std::move(name),
                  .a = recorder.number(bodies.a),
                  .b = recorder.number(bodies.b),
                  .in_a = {in_a[0], in_a[1], in_a[2]},
                  .turns = dJointGetType(joint.id()) != dJointTypeSlider,
                  .facts = std::move(facts)},
                 joint.queries(), std::move(life));
}

} // namespace ductile::replay
