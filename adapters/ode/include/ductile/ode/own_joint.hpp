// SPDX-License-Identifier: MIT
//
// A joint of ODE's own as rows of an island (solve/island.hpp), with the numbers that ODE would
// give it: ERP and CFM of the world or its own, motors, stops and their bounce, the spring of a
// hinge-2. Balls, hinges, sliders, universals, hinge-2 and fixed joints are known, and angular
// motors without stops; of others, linear motors too, ODE does not tell enough.
//
// How the bodies lay when the joint was set ODE does not tell either. That is how they lie when the
// joint is first seen here, or attached to others. What is further off than that later on, put
// elsewhere by hand or set anew, is left to ODE until it fits.
//
// Half a step ahead a pin is asked to hold at the end of the part (world/turned_contact.hpp), with
// the error that it had at its begin, as rows of plastic joints are (joint/any_link.hpp); the
// suspension of a hinge-2 is as it is in the middle.
//
// Symbols
//   e   how far A is from where B has it, or turned from there  [m | rad]
//   k   ERP over the step, by which it is pulled back           [1/s]
#pragma once

#include <ode/ode.h>

#include <array>
#include <cstddef>

#include "ductile/ode/convert.hpp"
#include "ductile/solve/island.hpp"
#include "ductile/vocabulary/linkage.hpp"
#include "ductile/world/island_joint.hpp"

namespace ductile::ode {

class OwnJoint {
  public:
    [[nodiscard]] static bool is_known(dJointID joint);

    /// Its bodies lie as it wants them to.
    explicit OwnJoint(dJointID joint);
    /// It is attached as it was, about the same axis.
    [[nodiscard]] bool is_same() const;
    /// Its bodies lie nearly as it wants them to.
    [[nodiscard]] bool fits() const;
    [[nodiscard]] dJointID id() const noexcept { return joint_; }

    /// Adds its rows for a step of `dt` [s]; `ahead`: its bodies are half a step ahead.
    void open_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b, double dt,
                   bool ahead);
    /// The island is solved: asks its pin for what fits bodies that leave the part so.
    [[nodiscard]] bool turn_rows(solve::Island& island, const IslandSeat& a, const IslandSeat& b,
                                 double dt);
    /// The island is solved: the impulses become forces on the bodies, and the joint's feedback.
    void close_rows(const solve::Island& island, double dt) const;

  private:
    struct Step;
    struct Row {
        Vector3<double> along{0, 0, 0}; ///< force on A, or moment, world
        Vector3<double> arm_a{0, 0, 0}, arm_b{0, 0, 0};
        bool turns = false;
    };
    /// One of its axes that may have a motor or stops.
    struct Axis {
        int number;
        Vector3<double> along; ///< world, unit
        bool turns = true;
        bool stops = true; ///< may have some
        double at = 0;     ///< [m | rad]
    };

    [[nodiscard]] static Vector3<double> axis_of(dJointID joint, bool reversed);
    /// e of a turn, world; of a slider or a fixed joint.
    [[nodiscard]] Vector3<double> turned() const;
    /// e of the same two where bodies' centres are.
    [[nodiscard]] Vector3<double> shifted() const;
    /// Of a hinge from A's axis to B's; of a hinge-2 what the angle between its axes is short of.
    [[nodiscard]] Vector3<double> leans() const;
    /// Of B's half of the pin from A's.
    [[nodiscard]] std::array<Vector3<double>, 2> pins() const;

    /// The first row of a hinge-2's pin.
    [[nodiscard]] bool is_sprung(std::size_t row) const {
        return row == 0 && kind_ == dJointTypeHinge2;
    }
    solve::IslandRow& pull(const Step& step, const Row& row, double target, double cfm);
    void hold_pin(const Step& step, const std::array<Vector3<double>, 3>& along, double rate,
                  double cfm);
    void hold_turn(const Step& step);
    void hold_across(const Step& step, const Vector3<double>& error, Row row);
    void hold_angle(const Step& step, const Vector3<double>& other, double error);
    [[nodiscard]] Row midway() const;
    void open_hinge(const Step& step);
    void open_slider(const Step& step);
    void open_universal(const Step& step);
    void open_hinge2(const Step& step);
    void open_fixed(const Step& step);
    void open_motor(const Step& step);
    void add_axis(const Step& step, const Axis& axis);
    [[nodiscard]] double parameter(int name, int axis = 0) const;

    dJointID joint_;
    dJointType kind_;
    AttachedBodies bodies_;
    Vector3<double> axis_a_{0, 0, 0}, axis_b_{0, 0, 0};  ///< in A and in B, unit
    double angle_ = 0;                                   ///< between the axes of a hinge-2 [rad]
    Matrix3<double> turn_ = Matrix3<double>::Identity(); ///< of B in A
    Vector3<double> place_{0, 0, 0}; ///< of A's centre in B, or of B's in A of a fixed joint [m]
    std::array<Row, 8> rows_{};
    int first_ = 0, count_ = 0;
    int pinned_ = 0;                 ///< of those, the first, that are its pin's
    Vector3<double> asked_{0, 0, 0}; ///< of the pin by the turning of its bodies, world [m/s]
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/own_joint.ipp"
#endif
