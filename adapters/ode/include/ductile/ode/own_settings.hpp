// SPDX-License-Identifier: MIT
//
// What a joint of ODE's has for itself of ERP and CFM, in place of the world's, and what a part or
// a blow makes of it (frame/part_settings.hpp): its rows, of a ball, fixed, double-ball,
// double-hinge joint or transmission; its stops, where it has some; the suspension of a hinge-2.
// Left as they are, a stop that is overrun within a frame is pushed back in parts of microseconds,
// at any speed.
//
// Two stops at one place that are soft are a spring and a damper, k = erp/(frame cfm), d = (1 -
// erp)/cfm. Set anew for each part they ask for the mean of its forces (law_row): ODE's row is u' +
// cfm f = -erp (at - stop)/h. So is the suspension of a hinge-2, of which a part sets ERP and CFM:
// its row is u' + cfm f = -erp x/h, with its strain x.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <cmath>
#include <span>
#include <vector>

#include "ductile/frame/part_engine.hpp"
#include "ductile/frame/part_settings.hpp"
#include "ductile/ode/joint_calls.hpp"
#include "ductile/ode/joint_stops.hpp"
#include "ductile/ode/own_axes.hpp"
#include "ductile/vocabulary/address_book.hpp"

namespace ductile::ode {

/// Of ODE's joints, what plastic ones go by.
struct OurJoints {
    AddressBook made;  ///< for themselves
    AddressBook ruled; ///< the user's, with a motor that is a plastic row

    void clear() noexcept {
        made.clear();
        ruled.clear();
    }
};

class OwnSettings {
  public:
    /// Rules the joints of these bodies for a part of `h` [s] in a frame of `frame` [s], or a blow,
    /// but for those that plastic joints made. Bodies are where they are solved, with the
    /// velocities that they begin with.
    void rule(std::span<const dBodyID> bodies, const OurJoints& ours, double h, double frame,
              bool blow) {
        put_back();
        springs_.clear();
        motors_.clear();
        const Part part{h, frame, blow};
        for (dBodyID body : bodies) {
            for (int i = 0, count = dBodyGetNumJoints(body); i < count; ++i) {
                const dJointID joint = dBodyGetJoint(body, i);
                if (dJointGetType(joint) == dJointTypeContact) continue;
                const dBodyID first = dJointGetBody(joint, 0);
                if ((first != body && first != nullptr) || ours.made.has(joint)) continue;
                if (!blow && !ours.ruled.has(joint)) note_motors(joint);
                rule(joint, part);
            }
        }
    }
    /// They are as they were.
    void put_back() {
        for (const Usual& usual : usual_) usual.set(usual.joint, usual.name, usual.value);
        usual_.clear();
    }
    /// What the springs, and the motors whose feedback tells, did in a part of `h` [s], as bodies
    /// leave it.
    [[nodiscard]] OwnForces forces(double h) const {
        OwnForces forces;
        for (const Motor& motor : motors_) {
            if (motor.stopped != no_axis && !left_stop(motor)) continue;
            const dJointFeedback* feedback = dJointGetFeedback(motor.joint);
            if (feedback == nullptr) continue;
            const OwnAxes axes = OwnAxes::of(motor.joint, attached_bodies(motor.joint));
            const Vector3<double> all = to_core(feedback->f1),
                                  moment = axes.moment(all, to_core(feedback->t1));
            const double force =
                motor.turns ? dot(moment, motor.along) : dot(axes.force(all), motor.along);
            forces.add_motor(motor.strength, motor.mass, force, motor.speed, h);
        }
        for (const Spring& spring : springs_) {
            const double end = spring.axis == suspension
                                   ? suspended(spring.joint).rate
                                   : stopped_axes(spring.joint).axes[spring.axis].rate;
            const double force = (spring.law.target - end) / (spring.law.compliance * h);
            forces.add_spring(spring.stiffness, spring.mass, force, spring.start, end, h);
        }
        return forces;
    }

  private:
    struct Part {
        double length, frame; ///< [s]
        bool blow;
    };
    struct Usual {
        dJointID joint;
        void (*set)(dJointID, int, dReal);
        int name;
        dReal value;
    };
    static constexpr std::size_t suspension = std::size_t(-1);
    struct Spring {
        dJointID joint;
        std::size_t axis;              ///< of its stops, or its suspension
        double stiffness, mass, start; ///< of the row; its velocity as the part began
        LawRow law;
    };

    struct Motor {
        dJointID joint;
        Vector3<double> along; ///< world, unit
        bool turns;
        double strength, mass, speed; ///< the last as the part began, less the motor's
        std::size_t stopped;          ///< of the joint's axes; no_axis: it is at no stop
        double meant;                 ///< the motor's
    };
    static constexpr std::size_t no_axis = std::size_t(-1);

    /// Where it does not, the joint's force is the stop's, too.
    [[nodiscard]] static bool left_stop(const Motor& motor) {
        const double rate = stopped_axes(motor.joint).axes[motor.stopped].rate;
        return std::abs(rate - motor.meant) < std::abs(rate);
    }

    void set(dJointID joint, int name, double value) {
        const JointCalls calls = joint_calls(dJointGetType(joint));
        usual_.push_back({joint, calls.set, name, calls.get(joint, name)});
        calls.set(joint, name, dReal(value));
    }
    void rule(dJointID joint, const Part& part) {
        const dJointType type = dJointGetType(joint);
        const JointCalls calls = joint_calls(type);
        const double h = part.length, frame = part.frame;
        const bool blow = part.blow;
        const auto usual = [&](int erp, int cfm) {
            return Softness{double(calls.get(joint, erp)), double(calls.get(joint, cfm))};
        };
        const auto lend = [&](int erp, int cfm, const Softness& as, bool in_blow) {
            set(joint, erp, in_blow ? 0 : as.erp);
            set(joint, cfm, in_blow ? as.compliance * blow_compliance(h) : as.compliance);
        };
        const auto soften = [&](int erp, int cfm) { // a share of what the frame removes
            const Softness own = usual(erp, cfm);
            lend(erp, cfm, blow ? own : part_spring(own, h, frame), blow);
        };
        if (calls.rows) {
            const Softness own = usual(dParamERP, dParamCFM);
            lend(dParamERP, dParamCFM, {part_erp(own.erp, h), own.compliance}, blow);
        }
        if (calls.suspension && !is_suspension(joint, part)) {
            soften(dParamSuspensionERP, dParamSuspensionCFM);
        }
        for (int axis = 0; axis < calls.stops; ++axis) {
            const int group = dParamGroup * axis;
            const bool stops = std::isfinite(calls.get(joint, dParamLoStop + group)) ||
                               std::isfinite(calls.get(joint, dParamHiStop + group));
            if (!stops || is_spring(joint, group, part)) continue;
            soften(dParamStopERP + group, dParamStopCFM + group);
        }
    }
    /// Of several about one joint each is told from the others where their axes are at right
    /// angles.
    void note_motors(dJointID joint) {
        const bool reversed = attached_bodies(joint).reversed;
        switch (dJointGetType(joint)) {
            case dJointTypeHinge:
                return note_motor(joint, 0, told(joint, dJointGetHingeAxis));
            case dJointTypeSlider:
                return note_motor(joint, 0, told(joint, dJointGetSliderAxis), false);
            case dJointTypeUniversal:
                note_motor(joint, reversed ? 1 : 0, told(joint, dJointGetUniversalAxis1));
                return note_motor(joint, reversed ? 0 : 1, told(joint, dJointGetUniversalAxis2));
            case dJointTypeHinge2:
                note_motor(joint, 0, told(joint, dJointGetHinge2Axis1));
                return note_motor(joint, 1, told(joint, dJointGetHinge2Axis2));
            case dJointTypeAMotor:
                for (int i = 0; i < dJointGetAMotorNumAxes(joint); ++i) {
                    dVector3 axis;
                    dJointGetAMotorAxis(joint, i, axis);
                    note_motor(joint, i, to_core(axis));
                }
                return;
            default:
                return;
        }
    }
    void note_motor(dJointID joint, int number, const Vector3<double>& along, bool turns = true) {
        const JointCalls calls = joint_calls(dJointGetType(joint));
        const auto get = [&](int name) {
            return double(calls.get(joint, name + dParamGroup * number));
        };
        const double strength = get(dParamFMax), yields = detail::yields_along(joint, along, turns);
        if (!(strength > 0) || !(yields > 0)) return;
        const auto [a, b, reversed] = attached_bodies(joint);
        // a slider that is attached as (null, body) counts its way the other way round
        const double way = !turns && reversed ? -1 : 1;
        const Vector3<double> apart = turns ? difference(angular_velocity(a), angular_velocity(b))
                                            : difference(linear_velocity(a), linear_velocity(b));
        const StoppedAxes axes = stopped_axes(joint);
        std::size_t stopped = no_axis;
        for (std::size_t i = 0; i < axes.count; ++i) {
            const StoppedAxis& axis = axes.axes[i];
            const bool at_it = axis.at <= axis.least || axis.at >= axis.most;
            if (axis.group == dParamGroup * number && axis.stops() && at_it) stopped = i;
        }
        const double speed = get(dParamVel);
        motors_.push_back({joint, along, turns, strength, 1 / yields,
                           way * dot(apart, along) - speed, stopped, speed});
    }
    /// One that a frame could follow, which it is now.
    bool is_spring(dJointID joint, int group, const Part& part) {
        constexpr double stiff = 1e4; // (ω frame)²
        const auto [h, frame, blow] = part;
        const StoppedAxes axes = stopped_axes(joint);
        for (std::size_t i = 0; i < axes.count; ++i) {
            const StoppedAxis& axis = axes.axes[i];
            if (axis.group != group || axis.least != axis.most || !(axis.yields > 0)) continue;
            const JointCalls calls = joint_calls(dJointGetType(joint));
            const auto erp = double(calls.get(joint, dParamStopERP + group));
            const auto cfm = double(calls.get(joint, dParamStopCFM + group));
            if (!(erp > 0 && erp <= 1 && cfm > 0)) continue;
            const double stiffness = erp / (frame * cfm), damping = (1 - erp) / cfm;
            if (stiffness * frame * frame * axis.yields > stiff) continue;
            if (blow) { // in which it gives nothing
                set(joint, dParamLoStop + group, -dInfinity);
                set(joint, dParamHiStop + group, dInfinity);
                return true;
            }
            const double mass = 1 / axis.yields;
            const LawRow law =
                law_row(stiffness, damping, mass, axis.at - axis.least, axis.rate, h);
            set(joint, dParamStopERP + group, 1);
            set(joint, dParamStopCFM + group, law.compliance * h);
            set(joint, dParamLoStop + group, axis.at + h * law.target);
            set(joint, dParamHiStop + group, axis.at + h * law.target);
            springs_.push_back({joint, i, stiffness, mass, axis.rate, law});
            return true;
        }
        return false;
    }

    struct Suspended {
        double strain, rate, yields; ///< [m] [m/s] [1/kg]
    };
    /// As the suspension of a hinge-2 is.
    [[nodiscard]] static Suspended suspended(dJointID joint) {
        const Vector3<double> along = told(joint, dJointGetHinge2Axis1),
                              of_a = told(joint, dJointGetHinge2Anchor),
                              of_b = told(joint, dJointGetHinge2Anchor2);
        const Vector3<double> moves = difference(velocity_at(dJointGetBody(joint, 0), of_a),
                                                 velocity_at(dJointGetBody(joint, 1), of_b));
        return {dot(difference(of_a, of_b), along), dot(moves, along),
                detail::yields_along(joint, along, false)};
    }
    /// One that a frame could follow, which it is now. ODE asks for ERP times its strain.
    bool is_suspension(dJointID joint, const Part& part) {
        constexpr double stiff = 1e4, nothing = 1e-12; // (ω frame)², [m]
        const auto [h, frame, blow] = part;
        const JointCalls calls = joint_calls(dJointGetType(joint));
        const auto erp = double(calls.get(joint, dParamSuspensionERP));
        const auto cfm = double(calls.get(joint, dParamSuspensionCFM));
        if (!(erp > 0 && erp <= 1 && cfm > 0)) return false;
        const auto [strain, rate, yields] = suspended(joint);
        const double stiffness = erp / (frame * cfm), damping = (1 - erp) / cfm;
        if (!(yields > 0) || stiffness * frame * frame * yields > stiff) return false;
        if (blow) {                            // in which it gives nothing
            constexpr double gives_way = 1e12; // [s/kg]
            set(joint, dParamSuspensionERP, 0);
            set(joint, dParamSuspensionCFM, gives_way);
            return true;
        }
        const LawRow law = law_row(stiffness, damping, 1 / yields, strain, rate, h);
        if (!(std::abs(strain) > nothing) && law.target != 0) return false;
        set(joint, dParamSuspensionERP, strain == 0 ? 0 : -law.target * h / strain);
        set(joint, dParamSuspensionCFM, law.compliance * h);
        springs_.push_back({joint, suspension, stiffness, 1 / yields, rate, law});
        return true;
    }

    std::vector<Usual> usual_;
    std::vector<Spring> springs_;
    std::vector<Motor> motors_;
};

} // namespace ductile::ode
