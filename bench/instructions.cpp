// SPDX-License-Identifier: MIT
//
// How many instructions does one joint take beside the engine's own? Makes a field of joints, steps
// it and says nothing: bench/instructions.py runs it in callgrind for two numbers of steps and
// divides the difference, in which making, warming up and ending cancel.
//
//   instructions-bullet-double JOINT SET-UP JOINTS STEPS
//   instructions-bullet-double --list        engine, precision, library; then our joints and the
//                                            set-ups that each is of interest in, a pair per line
//
//   set-up          pairs-flowing, pairs-at-rest, chain-at-rest, ground-flowing, post-standing,
//                   fives-standing, fives-flowing, floor-sticking, floor-sliding: islands of
//                   cost/field.hpp
//   library         header-only, or compiled where the program is linked against the compiled
//                   library
//
// Solvers as in joint_cost: Bullet's sequential impulse with ten iterations; in ODE dWorldStep for
// islands, dWorldQuickStep with twenty iterations for a chain. plastic-hinge-ledger: plastic-hinge,
// each looked after by a ductile World that keeps the energy ledger.
#include <array>
#include <charconv>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#ifdef BENCH_ODE
#include "cost/ode_field.hpp"
#else
#include "cost/bullet_field.hpp"
#endif

using namespace bench::cost;

namespace {

constexpr std::string_view ledger_name = "plastic-hinge-ledger";
#ifdef DUCTILE_COMPILED
constexpr std::string_view library = "compiled";
#else
constexpr std::string_view library = "header-only";
#endif

struct Case {
    std::string_view name;
    SetUp set_up;
    bool flowing;
    std::array<std::string_view, 3> joints; ///< of ours, of interest here
};
constexpr std::string_view hinge = "plastic-hinge", six = "plastic-joint";
constexpr std::array<Case, 9> cases{
    {{"pairs-flowing", SetUp::pairs, true, {hinge, six, ledger_name}},
     {"pairs-at-rest", SetUp::pairs, false, {hinge, six, ledger_name}},
     {"chain-at-rest", SetUp::chain, false, {hinge, six, ledger_name}},
     {"ground-flowing", SetUp::ground, true, {hinge}},
     {"post-standing", SetUp::post, false, {six}},
     {"fives-standing", SetUp::fives, false, {hinge}},
     {"fives-flowing", SetUp::fives, true, {hinge}},
     {"floor-sticking", SetUp::floor, false, {hinge}},
     {"floor-sliding", SetUp::floor, true, {hinge}}}};

int whole_number(const char* name, std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1) {
        throw std::invalid_argument(std::string(name) + " = " + std::string(text) +
                                    ": must be a whole number from 1");
    }
    return value;
}

FieldSettings settings_of(std::string_view joint, std::string_view name, int joints) {
    for (const Case& c : cases) {
        if (c.name != name || !Field::has(c.set_up)) continue;
        const bool ledger = joint == ledger_name;
        for (const auto& [kind, called] : joint_names) {
            if (called != (ledger ? hinge : joint) || !Field::has(kind)) continue;
            return {.joint = kind,
                    .count = joints,
                    .set_up = c.set_up,
                    .weak_every = c.flowing ? 1 : 0,
                    .direct = c.set_up != SetUp::chain,
                    .ledger = ledger};
        }
        throw std::invalid_argument("JOINT = " + std::string(joint) + ": none has this name here");
    }
    throw std::invalid_argument("SET-UP = " + std::string(name) + ": none has this name here");
}

void list() {
    std::printf("%s,%s,%s\n", Field::engine.data(), Field::precision.data(), library.data());
    for (const Case& c : cases) {
        if (!Field::has(c.set_up)) continue;
        for (const std::string_view joint : c.joints) {
            if (!joint.empty()) std::printf("%s %s\n", joint.data(), c.name.data());
        }
    }
}

} // namespace

int main(int argc, char** argv) try {
    if (argc == 2 && std::string_view(argv[1]) == "--list") {
        list();
        return 0;
    }
    if (argc != 5) {
        std::fprintf(stderr, "usage: %s JOINT SET-UP JOINTS STEPS | --list\n", argv[0]);
        return 2;
    }
    const int joints = whole_number("JOINTS", argv[3]), steps = whole_number("STEPS", argv[4]);
    Field field(settings_of(argv[1], argv[2], joints));
    for (int i = 0; i < steps; ++i) field.step();
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
