// SPDX-License-Identifier: MIT
//
// P12. Portal frames, fixed feet, V at mid-beam and H at the eaves in proportion: of the beam, sway
// and combined mechanisms the weakest governs, and the frame is still just below it.
//
//   combined   λ_c (H h + V L/2) = Σ M_p θ over feet (θ), mid-beam (2θ) and far knee (2θ)
//
// Source: Neal (1977), The Plastic Methods of Structural Analysis; Horne (1979), Plastic Theory of
// Structures.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <deque>

#include "reference/world.hpp"

using namespace ductile;
using namespace ductile::reference;

namespace {

struct Portal {
    double height = 4, span = 8;               // [m]
    double column_moment = 0, beam_moment = 0; // [N m]
    double vertical = 0, horizontal = 0;       // [N]
    double column_mass = 300, beam_mass = 600; // [kg]
};

/// Two columns and two halves of the beam. A knee of two members is a small body of its own with a
/// hinge to each, so that the weaker one decides; `plain_knees` puts the weaker hinge there
/// directly.
class Frame {
  public:
    Frame(const Portal& p, bool plain_knees) : p_(p) {
        const double h = p.height, half = p.span / 2;
        left_ = rod(p.column_mass, h, {0, h / 2});
        right_ = rod(p.column_mass, h, {p.span, h / 2});
        near_ = rod(p.beam_mass / 2, half, {half / 2, h});
        far_ = rod(p.beam_mass / 2, half, {1.5 * half, h});
        join(ground, left_, {0, 0}, p.column_moment);
        join(ground, right_, {p.span, 0}, p.column_moment);
        join(near_, far_, {half, h}, p.beam_moment);
        knee(left_, near_, {0, h}, plain_knees);
        knee(right_, far_, {p.span, h}, plain_knees);
    }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    /// Largest rate of the columns after steps from rest at this load factor [rad/s].
    double sway_rate(double factor, int steps, double dt) {
        Vector<double> load = world_.no_load();
        load[left_.x] = factor * p_.horizontal; // at the eaves: through the centre, and its moment
        load[left_.angle()] = -factor * p_.horizontal * p_.height / 2;
        load[near_.y()] = -factor * p_.vertical;
        load[near_.angle()] = -factor * p_.vertical * p_.span / 4;
        for (int i = 0; i < steps; ++i) world_.step(dt, load);
        for (const auto& joint : joints_) CHECK(joint.state().residual_max < 1e-9);
        return world_.velocity()[left_.angle()];
    }
    double middle_velocity() {
        return world_.velocity()[near_.y()] + world_.velocity()[near_.angle()] * p_.span / 4;
    }
    double fastest() { return world_.velocity().cwiseAbs().maxCoeff(); }
    /// Moment in the near knee in the last step [N m].
    double near_knee_moment() const { return world_.reaction(near_knee_).force; }

  private:
    Body rod(double mass, double length, const Point<double>& centre) {
        return world_.add_body(mass, mass * length * length / 12, centre);
    }
    std::size_t join(Body a, Body b, const Point<double>& where, double moment) {
        world_.add_pin(a, b, where);
        joints_.emplace_back(Perfect<double>({.strength = moment}));
        return world_.add_hinge(a, b, joints_.back());
    }
    void knee(Body column, Body beam, const Point<double>& where, bool plain) {
        std::size_t row = 0;
        if (plain) {
            row = join(column, beam, where, std::min(p_.column_moment, p_.beam_moment));
        } else {
            const Body node = world_.add_body(1, 0.01, where);
            row = join(column, node, where, p_.column_moment);
            join(node, beam, where, p_.beam_moment);
        }
        if (where.x() == 0) near_knee_ = row;
    }

    Portal p_;
    World<double> world_;
    std::deque<OneAxisJoint<Perfect<double>>> joints_;
    Body left_, right_, near_, far_;
    std::size_t near_knee_ = 0;
};

constexpr Portal even{
    .column_moment = 100e3, .beam_moment = 100e3, .vertical = 60e3, .horizontal = 40e3};
constexpr Portal strong_beam{
    .column_moment = 90e3, .beam_moment = 150e3, .vertical = 90e3, .horizontal = 35e3};
constexpr double dt = 1e-3;

} // namespace

TEST_CASE("P12 a portal is still just below its collapse factor and moves just above",
          "[reference][P12]") {
    struct Case {
        const char* name;
        Portal portal;
        double factor;
    };
    // beam alone, sway alone and combined, each where it governs
    Portal only_down = even, only_across = even;
    only_down.horizontal = 0;
    only_across.vertical = 0;
    for (const auto& [name, portal, factor] :
         {Case{"a, combined", even, 1.5}, Case{"b, combined", strong_beam, 1.32},
          Case{"a, beam", only_down, 1.666666667}, Case{"a, sway", only_across, 2.5}}) {
        for (const bool plain : {true, false}) {
            INFO(name << (plain ? ", plain knees" : ", knees of two hinges"));
            // 0.1 % of the load accelerates the frame at about 0.04 rad/s²; round-off is far below
            Frame below(portal, plain), above(portal, plain);
            below.sway_rate(0.999 * factor, 50, dt);
            CHECK(below.fastest() < 1e-10);
            above.sway_rate(1.001 * factor, 1, dt);
            CHECK(above.fastest() > 1e-5);
        }
    }
}

TEST_CASE("P12 the combined mechanism starts with its own acceleration", "[reference][P12]") {
    // θ'' = (λ (H h + V L/2) - 6 M_p)/16000, mid-beam sinks by L/2 θ''. Balance of the two columns
    // and of the beam's sway, H = 66 kN: the near knee carries 84 kN m.
    Frame frame(even, true);
    const double rate = -frame.sway_rate(1.1 * 1.5, 1, dt) / dt; // it sways to the right
    CHECK(rate == Approx(3.75).epsilon(1e-9));
    CHECK(-frame.middle_velocity() / dt == Approx(4 * 3.75).epsilon(1e-9));
    CHECK(std::abs(frame.near_knee_moment()) == Approx(84e3).epsilon(1e-9));
}

TEST_CASE("P12 far above collapse the inertia makes the near knee yield too", "[reference][P12]") {
    // 1.5 λ_c. One mechanism alone (18.75 rad/s²) would ask 180 kN m of the near knee. With all
    // five hinges and two freedoms, columns θ and beam halves φ > θ, virtual work gives
    //   12800 θ'' = λ H h - 2 M_p,   3200 φ'' = λ V L/2 - 4 M_p
    Frame frame(even, true);
    const double rate = -frame.sway_rate(1.5 * 1.5, 1, dt) / dt;
    CHECK(rate == Approx((2.25 * 160e3 - 200e3) / 12800).epsilon(1e-9));
    CHECK(-frame.middle_velocity() / dt == Approx(4 * (2.25 * 240e3 - 400e3) / 3200).epsilon(1e-9));
    CHECK(std::abs(frame.near_knee_moment()) == Approx(100e3).epsilon(1e-9));
}
