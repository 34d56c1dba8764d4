// SPDX-License-Identifier: MIT
//
// What it takes to use the core in an engine that has no adapter yet.
//
// Part 1 is an engine as many people have written one: planar rigid bodies, pins, rows with bounds,
// sequential impulses. It knows nothing of plasticity; all it offers is rows
//
//   u' + C λ = b,   lower dt <= λ <= upper dt
//
// Part 2 is the port: read the row's motion, hand the joint's limits to the row, hand the row's
// reaction to the joint, give back what a break took in excess.
//
// Part 3 is a problem: two wheels on one axle, 2 kg m² at 10 rad/s and 3 kg m² at rest, fly through
// space. The hinge between them carries 12 N m and breaks after 3.2 rad. It takes 12 × 3.2 = 38.4
// J, of the 60 J of their relative motion (reduced inertia 1.2 kg m²), which leaves √(10² - 2 ×
// 38.4/1.2) = 6 rad/s between them and, as their momentum stays, 7.6 and 1.6 rad/s. Nothing of that
// may depend on the step. Expected output:
//
//   dt [s]         took [J]    turned [rad]   spin 1 [rad/s]   spin 2 [rad/s]
//   exact         38.400000        3.200000         7.600000         1.600000
//   1/15          38.400000        3.200000         7.600000         1.600000
//   1/60          38.400000        3.200000         7.600000         1.600000
//   1/240         38.400000        3.200000         7.600000         1.600000
//   1/1000        38.400000        3.200000         7.600000         1.600000
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/joint/planar_release.hpp"

// ---- Part 1: the engine -------------------------------------------------------------------------

namespace engine {

constexpr double unbounded = std::numeric_limits<double>::infinity();

struct Body {
    double inverse_mass = 0, inverse_inertia = 0; // zero: does not move
    double x = 0, y = 0, angle = 0;
    double vx = 0, vy = 0, spin = 0;
};

/// How a row sees one body.
struct Side {
    Body* body = nullptr;
    double x = 0, y = 0, angle = 0;

    double velocity() const { return x * body->vx + y * body->vy + angle * body->spin; }
    double inverse_mass() const {
        return (x * x + y * y) * body->inverse_mass + angle * angle * body->inverse_inertia;
    }
    void push(double impulse) const {
        body->vx += impulse * x * body->inverse_mass;
        body->vy += impulse * y * body->inverse_mass;
        body->spin += impulse * angle * body->inverse_inertia;
    }
};

struct Row {
    Side a, b;
    double bias = 0, compliance = 0, lower = -unbounded, upper = unbounded; // forces, not impulses
    double impulse = 0;

    double velocity() const { return a.velocity() + b.velocity(); }
    void solve(double dt) {
        const double miss = bias - velocity() - compliance * impulse;
        const double wanted = impulse + miss / (a.inverse_mass() + b.inverse_mass() + compliance);
        const double next = std::fmin(std::fmax(wanted, lower * dt), upper * dt);
        a.push(next - impulse);
        b.push(next - impulse);
        impulse = next;
    }
};

struct Point {
    double x, y;
};

/// Where a point of a body is now, from its centre.
Point arm(const Body& body, const Point& local) {
    const double c = std::cos(body.angle), s = std::sin(body.angle);
    return {c * local.x - s * local.y, s * local.x + c * local.y};
}

struct Pin {
    Body *a, *b;
    Point on_a, on_b;

    std::array<Row, 2> rows(double dt) const {
        const Point ra = arm(*a, on_a), rb = arm(*b, on_b);
        const double gap_x = b->x + rb.x - a->x - ra.x, gap_y = b->y + rb.y - a->y - ra.y;
        return {Row{{a, -1, 0, ra.y}, {b, 1, 0, -rb.y}, -0.2 * gap_x / dt},
                Row{{a, 0, -1, -ra.x}, {b, 0, 1, rb.x}, -0.2 * gap_y / dt}};
    }
};

void solve(std::vector<Row>& rows, double dt, int iterations = 200) {
    for (int i = 0; i < iterations; ++i) {
        for (Row& row : rows) row.solve(dt);
    }
}

void move(Body& body, double dt) {
    body.x += body.vx * dt;
    body.y += body.vy * dt;
    body.angle += body.spin * dt;
}

} // namespace engine

// ---- Part 2: the port ---------------------------------------------------------------------------

/// A plastic hinge at a pin: one more row on the angle between its bodies.
template <class Joint>
class PlasticHinge {
  public:
    PlasticHinge(const engine::Pin& pin, Joint joint) : pin_(pin), joint_(std::move(joint)) {}

    const Joint& joint() const { return joint_; }

    engine::Row row(double dt) {
        engine::Row row{{pin_.a, 0, 0, -1}, {pin_.b, 0, 0, 1}};
        const ductile::RowLimits<double> limits =
            joint_.prepare({.position = angle(), .velocity = row.velocity()}, dt);
        row.lower = limits.lower;
        row.upper = limits.upper;
        row.bias = limits.bias;
        row.compliance = limits.compliance;
        return row;
    }

    /// After the bodies moved.
    void commit(const engine::Row& row, double dt) {
        const ductile::Step<double> step =
            joint_.commit({row.impulse / dt, row.velocity(), angle()}, dt);
        if (step.release > 0) give_back(step.release);
    }

  private:
    double angle() const { return pin_.b->angle - pin_.a->angle; }

    static ductile::PlanarBody<double> at_joint(const engine::Body& body,
                                                const engine::Point& local) {
        const engine::Point r = engine::arm(body, local);
        return {body.inverse_mass, body.inverse_inertia, r.x, r.y, {body.vx, body.vy, body.spin}};
    }
    static void change(engine::Body& body, const ductile::PlanarVelocity<double>& by) {
        body.vx += by.x;
        body.vy += by.y;
        body.spin += by.spin;
    }
    void give_back(double energy) {
        engine::Body &a = *pin_.a, &b = *pin_.b;
        const auto release =
            ductile::planar_release(at_joint(a, pin_.on_a), at_joint(b, pin_.on_b), energy);
        change(a, release.a);
        change(b, release.b);
    }

    engine::Pin pin_;
    Joint joint_;
};

// ---- Part 3: two wheels, one axle ---------------------------------------------------------------

int main() {
    using namespace ductile;
    const char* line = "%-7s  %14.6f  %14.6f  %15.6f  %15.6f\n";
    std::printf("%-7s  %14s  %14s  %15s  %15s\n", "dt [s]", "took [J]", "turned [rad]",
                "spin 1 [rad/s]", "spin 2 [rad/s]");
    std::printf(line, "exact", 38.4, 3.2, 7.6, 1.6);
    for (const int rate : {15, 60, 240, 1000}) {
        const double dt = 1.0 / rate;
        engine::Body one{.inverse_mass = 1 / 40.0, .inverse_inertia = 1 / 2.0, .vx = 3, .spin = 10};
        engine::Body two{.inverse_mass = 1 / 60.0, .inverse_inertia = 1 / 3.0, .vx = 3};
        const engine::Pin axle{&two, &one, {0, 0}, {0, 0}};
        PlasticHinge hinge(axle, OneAxisJoint(Perfect<double>({.strength = 12}),
                                              TravelLimit<double>({.limit = 3.2})));
        while (!hinge.joint().state().broken) {
            const auto [across, along] = axle.rows(dt);
            std::vector<engine::Row> rows{across, along, hinge.row(dt)};
            engine::solve(rows, dt);
            for (engine::Body* body : {&one, &two}) engine::move(*body, dt);
            hinge.commit(rows.back(), dt);
        }
        const auto& state = hinge.joint().state();
        std::printf(line, ("1/" + std::to_string(rate)).c_str(), state.plastic_work,
                    state.plastic_travel, one.spin, two.spin);
    }
}
