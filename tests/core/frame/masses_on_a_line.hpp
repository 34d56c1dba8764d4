// SPDX-License-Identifier: MIT
//
// An engine of some lines for tests of frames: masses on a line, rigid-plastic rows between them,
// one-sided contacts, constant forces and springs of others. Solved by sweeps to round-off.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "ductile/frame/part_engine.hpp"

namespace masses_on_a_line {

constexpr int ground = -1;

struct Mass {
    double mass, velocity = 0, position = 0, force = 0, spring = 0; ///< force + -spring x
};
/// Holds b to a below its strength R; the sign of u is that of v_b - v_a.
struct PlasticRow {
    int a, b;
    double strength;
    int island = -1;
    double travel = 0, work = 0;
};
/// a before b: they push each other where the gap is closed.
struct Contact {
    int a, b;
};

/// Holds b to a, whatever it takes.
struct Tie {
    int a, b;
    bool tells = false; ///< what it took: a rigid row of a joint
};

class Engine final : public ductile::PartEngine {
  public:
    std::vector<Mass> masses;
    std::vector<PlasticRow> rows;
    std::vector<Contact> contacts;
    std::vector<Tie> ties;
    bool foresees = true;     ///< gaps that close
    double kick = 0;          ///< rigid_work of every part, whatever its length [J]
    double stored = 0;        ///< by elastic joints [J]
    bool breaks_down = false; ///< its answers are no numbers
    double time = 0;
    int solves = 0;
    std::vector<double> accepted;

    void save() override { kept_ = {masses, rows, time}; }
    void put_back() override {
        masses = kept_.masses;
        rows = kept_.rows;
        time = kept_.time;
    }
    const ductile::PartMotion& part(double h) override { return go(h, h); }
    const ductile::PartMotion& blow() override { return go(1e-9, 0); }
    void accept(double h) override {
        if (h > 0) accepted.push_back(h);
    }
    ductile::ClosingContacts closing(double h, double touching, double apart) override {
        ductile::ClosingContacts result;
        if (!foresees) return result;
        for (const Contact& c : contacts) {
            const double speed = -relative(c.a, c.b), gap = this->gap(c);
            const double mass = 1 / (inverse(c.a) + inverse(c.b));
            const double energy = mass * speed * speed / 2;
            if (speed <= 0) continue;
            if (gap < closed) {
                result.strikes = result.strikes || energy > touching;
            } else if (energy > apart && gap / speed < h) {
                result.time = std::min(result.time, gap / speed);
            }
        }
        return result;
    }
    double kinetic_energy() const override {
        double sum = 0;
        for (const Mass& m : masses) sum += m.mass * m.velocity * m.velocity / 2;
        return sum;
    }

  private:
    static constexpr double closed = 2e-6;
    struct Kept {
        std::vector<Mass> masses;
        std::vector<PlasticRow> rows;
        double time = 0;
    };
    double velocity(int i) const { return i == ground ? 0 : masses[std::size_t(i)].velocity; }
    double inverse(int i) const { return i == ground ? 0 : 1 / masses[std::size_t(i)].mass; }
    double relative(int a, int b) const { return velocity(b) - velocity(a); }
    double gap(const Contact& c) const {
        const auto at = [this](int i) { return i == ground ? 0 : masses[std::size_t(i)].position; };
        return at(c.b) - at(c.a);
    }
    void push(int a, int b, double impulse) {
        if (a != ground) masses[std::size_t(a)].velocity -= impulse * inverse(a);
        if (b != ground) masses[std::size_t(b)].velocity += impulse * inverse(b);
    }

    /// `moves`: how long the masses move; impulses are those of `h`.
    const ductile::PartMotion& go(double h, double moves) {
        ++solves;
        motion_ = {};
        std::vector<double> start;
        for (const PlasticRow& r : rows) start.push_back(relative(r.a, r.b));
        std::vector<double> closing, parting;
        for (Mass& m : masses) m.position += m.velocity * moves / 2;
        for (const Contact& c : contacts) closing.push_back(relative(c.a, c.b));
        for (const Tie& t : ties) parting.push_back(relative(t.a, t.b));
        for (Mass& m : masses) m.velocity += (m.force - m.spring * m.position) / m.mass * h;
        std::vector<double> impulse(rows.size() + contacts.size() + ties.size(), 0);
        for (int sweep = 0; sweep < 4000; ++sweep) {
            double most = 0;
            const auto relax = [&](std::size_t i, int a, int b, double low, double high) {
                const double wanted = impulse[i] - relative(a, b) / (inverse(a) + inverse(b));
                const double change = std::clamp(wanted, low, high) - impulse[i];
                impulse[i] += change;
                push(a, b, change);
                most = std::max(most, std::abs(change));
            };
            for (std::size_t i = 0; i < rows.size(); ++i) {
                relax(i, rows[i].a, rows[i].b, -rows[i].strength * h, rows[i].strength * h);
            }
            for (std::size_t i = 0; i < contacts.size(); ++i) {
                if (gap(contacts[i]) >= closed) continue;
                relax(rows.size() + i, contacts[i].a, contacts[i].b, 0, 1e30);
            }
            for (std::size_t i = 0; i < ties.size(); ++i) {
                relax(rows.size() + contacts.size() + i, ties[i].a, ties[i].b, -1e30, 1e30);
            }
            if (most < 1e-14) break;
        }
        for (Mass& m : masses) m.position += m.velocity * moves / 2;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            PlasticRow& r = rows[i];
            const double end = relative(r.a, r.b), force = impulse[i] / h;
            r.travel += std::abs(start[i] + end) / 2 * h;
            r.work -= impulse[i] * (start[i] + end) / 2;
            motion_.rows.push_back({.joint = i,
                                    .island = r.island,
                                    .work = r.work,
                                    .start = start[i],
                                    .end = breaks_down ? std::nan("") : end,
                                    .share = std::abs(force) / r.strength,
                                    .force = force,
                                    .strength = r.strength,
                                    .noise = 1e-9,
                                    .least = 1e-6});
            motion_.plastic_work += r.work;
        }
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const double end = relative(contacts[i].a, contacts[i].b);
            motion_.contact_work -= impulse[rows.size() + i] * (closing[i] + end) / 2;
        }
        motion_.rigid_work = kick;
        motion_.stored = stored;
        for (std::size_t i = 0; i < ties.size(); ++i) {
            if (!ties[i].tells) continue;
            const double end = relative(ties[i].a, ties[i].b);
            motion_.rigid_work -=
                impulse[rows.size() + contacts.size() + i] * (parting[i] + end) / 2;
        }
        time += moves;
        return motion_;
    }

    Kept kept_;
    ductile::PartMotion motion_;
};

} // namespace masses_on_a_line
