// SPDX-License-Identifier: MIT
//
// How many instructions does one joint take beside the engine's own? Makes a field of joints, steps
// it and says nothing: bench/instructions.py runs it in callgrind for two numbers of steps and
// divides the difference, in which making, warming up and ending cancel.
//
//   instructions-bullet-double JOINT SET-UP JOINTS STEPS
//   instructions-bullet-double --list        engine, precision, library; then the joints, one per
//   line
//
//   set-up          pairs-flowing   JOINTS pairs of bodies that turn against each other, weak
//   joints
//                   pairs-at-rest   the same pairs, which strong joints stop in the first step
//                   chain-at-rest   one chain of JOINTS + 1 bodies, strong joints
//   library         header-only, or compiled where the program is linked against the compiled
//   library
//
// Solvers as in joint_cost: Bullet's sequential impulse with ten iterations; in ODE dWorldStep for
// pairs, dWorldQuickStep with twenty iterations for a chain. plastic-hinge-ledger: plastic-hinge,
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
#include "instructions/ode_ledger_field.hpp"
#else
#include "cost/bullet_field.hpp"
#include "instructions/bullet_ledger_field.hpp"
#endif

using namespace bench::cost;

namespace {

constexpr std::string_view ledger_name = "plastic-hinge-ledger";
#ifdef DUCTILE_COMPILED
constexpr std::string_view library = "compiled";
#else
constexpr std::string_view library = "header-only";
#endif

struct SetUp {
    std::string_view name;
    bool chain, flowing;
};
constexpr std::array<SetUp, 3> set_ups{{{"pairs-flowing", false, true},
                                        {"pairs-at-rest", false, false},
                                        {"chain-at-rest", true, false}}};

int whole_number(const char* name, std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1) {
        throw std::invalid_argument(std::string(name) + " = " + std::string(text) +
                                    ": must be a whole number from 1");
    }
    return value;
}

FieldSettings settings_of(std::string_view set_up, int joints) {
    for (const SetUp& s : set_ups) {
        if (s.name != set_up) continue;
        return {
            .count = joints, .chain = s.chain, .weak_every = s.flowing ? 1 : 0, .direct = !s.chain};
    }
    throw std::invalid_argument("SET-UP = " + std::string(set_up) + ": none has this name");
}

template <class AnyField>
void run(const FieldSettings& settings, int steps) {
    AnyField field(settings);
    for (int i = 0; i < steps; ++i) field.step();
}

void run(std::string_view joint, FieldSettings settings, int steps) {
    if (joint == ledger_name) return run<LedgerField>(settings, steps);
    for (const auto& [kind, name] : joint_names) {
        if (name != joint || !Field::has(kind)) continue;
        settings.joint = kind;
        return run<Field>(settings, steps);
    }
    throw std::invalid_argument("JOINT = " + std::string(joint) + ": none has this name here");
}

void list() {
    std::printf("%s,%s,%s\n", Field::engine.data(), Field::precision.data(), library.data());
    for (const auto& [kind, name] : joint_names) {
        if (Field::has(kind)) std::printf("%s\n", name.data());
    }
    std::printf("%s\n", ledger_name.data());
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
    run(argv[1], settings_of(argv[2], whole_number("JOINTS", argv[3])),
        whole_number("STEPS", argv[4]));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
