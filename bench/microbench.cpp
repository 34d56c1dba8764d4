// SPDX-License-Identifier: MIT
//
// What the core costs by itself: prepare + commit of one-axis joints without any engine. What the
// adapters add to it is in microbench_adapters.cpp, cases of the same program.
//
//   scalar  an array of OneAxisJoint, one after the other
//   batch   OneAxisBatch over arrays
//   six     an array of CoupledJoint: six axes on one ellipsoid
//   copy    memcpy that reads and writes as many bytes as the batch's two calls do together: what
//           the memory allows. memcpy streams past the cache where an ordinary loop first has to
//           read the lines it is going to write, so the copy is a hard baseline.
//
// Time is per joint and step; bytes are those of the batch's header. Every joint has its motion and
// reaction in arrays, as an engine would hand them over; a share of them, scattered at random,
// flows at its bound, the others hold.
//
// Run with --quick for a smoke test, else with --benchmark_repetitions=9 and
// --benchmark_report_aggregates_only=true on a quiet machine.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/batch/batch_storage.hpp"
#include "ductile/batch/one_axis_batch.hpp"
#include "ductile/joint/coupled_joint.hpp"
#include "ductile/joint/one_axis_joint.hpp"
#include "ductile/law/perfect.hpp"
#include "ductile/surface/ellipsoid.hpp"

using namespace ductile;

namespace {

enum class Rows { rigid, elastic };

constexpr double step = 1e-3;
constexpr double strength = 40;
/// Never reached, but looked at: an infinite one could be cheaper.
constexpr double limit = 1e30;

template <class S>
inline constexpr std::size_t batch_bytes_read = 18 * sizeof(S) + 2;
template <class S>
inline constexpr std::size_t batch_bytes_written = 12 * sizeof(S) + 1;

/// Motion and reaction of joints of which `yielding` percent flow at their bound.
template <class S>
BatchStorage<S> scene(std::size_t joints, long yielding) {
    BatchStorage<S> memory(joints);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < joints; ++i) {
        const bool flows = long(random() % 100) < yielding;
        const bool forwards = random() % 2 == 0;
        const S sign = S(forwards ? 1 : -1);
        memory.velocity[i] = flows ? sign * S(0.5) : S(0);
        memory.velocity_after[i] = flows ? sign * S(0.48) : S(0);
        memory.force[i] = -sign * S(flows ? strength : 0.3 * strength);
    }
    return memory;
}

/// Time per joint and step, and bytes moved per second where they are known.
void report(benchmark::State& state, std::size_t joints, std::size_t bytes) {
    state.counters["per joint"] =
        benchmark::Counter(double(joints), benchmark::Counter::kIsIterationInvariantRate |
                                               benchmark::Counter::kInvert);
    if (bytes == 0) return;
    state.counters["bytes/s"] =
        benchmark::Counter(double(joints * bytes), benchmark::Counter::kIsIterationInvariantRate);
}

template <class S>
void scalar(benchmark::State& state) {
    const auto joints = std::size_t(state.range(0));
    const BatchStorage<S> memory = scene<S>(joints, long(state.range(1)));
    std::vector bank(joints, OneAxisJoint(Perfect<S>({.strength = S(strength)}),
                                          TravelLimit<S>({.limit = S(limit)})));
    std::vector<RowLimits<S>> rows(joints);
    std::vector<Step<S>> steps(joints);
    for (auto _ : state) {
        for (std::size_t i = 0; i < joints; ++i) {
            rows[i] = bank[i].prepare({memory.position[i], memory.velocity[i]}, S(step));
        }
        benchmark::ClobberMemory();
        for (std::size_t i = 0; i < joints; ++i) {
            steps[i] = bank[i].commit(
                {memory.force[i], memory.velocity_after[i], memory.position_after[i]}, S(step));
        }
        benchmark::ClobberMemory();
    }
    for (std::size_t i = 0; i < joints; ++i) {
        if ((steps[i].outcome == Outcome::yielding) != (memory.velocity[i] != 0)) {
            state.SkipWithError("the joints that should yield are not those that do");
        }
    }
    report(state, joints, 0);
}

template <class S>
void batch(benchmark::State& state) {
    const auto joints = std::size_t(state.range(0));
    BatchStorage<S> memory = scene<S>(joints, long(state.range(1)));
    OneAxisBatch bank(
        batch_law(Perfect<S>({.strength = S(strength)}), TravelLimit<S>({.limit = S(limit)})),
        memory.arrays());
    for (auto _ : state) {
        bank.prepare(S(step));
        benchmark::ClobberMemory();
        bank.commit(S(step));
        benchmark::ClobberMemory();
    }
    for (std::size_t i = 0; i < joints; ++i) {
        if ((bank.outcome(i) == Outcome::yielding) != (memory.velocity[i] != 0)) {
            state.SkipWithError("the joints that should yield are not those that do");
        }
    }
    report(state, joints, batch_bytes_read<S> + batch_bytes_written<S>);
}

template <class S>
void copy(benchmark::State& state) {
    const auto joints = std::size_t(state.range(0));
    constexpr std::size_t bytes = batch_bytes_read<S> + batch_bytes_written<S>;
    const std::size_t half = joints * bytes / 2; // read once, written once
    std::vector<char> from(half, 1), to(half, 2);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), half);
        benchmark::DoNotOptimize(to.data());
        benchmark::ClobberMemory();
    }
    report(state, joints, bytes);
}

/// Three forces and three moments of a beam's end: unequal capacities, and a mass in which shear and
/// bending are coupled.
template <class S, Rows kind>
void six(benchmark::State& state) {
    using Surface = Ellipsoid<S, 6>;
    using Joint = CoupledJoint<Surface, Perfect<S>>;
    using Vector = typename Joint::Vector;
    const auto joints = std::size_t(state.range(0));
    const BatchStorage<S> memory = scene<S>(joints, long(state.range(1)));
    const Vector capacity = S(strength) * Vector{{S(5), S(3), S(2), S(0.8), S(1), S(1.2)}};
    typename Joint::Matrix mass = Vector{{S(5), S(4), S(4), S(0.1), S(0.2), S(0.2)}}.asDiagonal();
    mass(1, 5) = mass(5, 1) = S(0.4);
    mass(2, 4) = mass(4, 2) = S(-0.4);
    typename Joint::Parameters parameters;
    if (kind == Rows::elastic) parameters.stiffness = S(1e4) * capacity; // yields at 0.1 mm
    std::vector<Joint> bank(joints, Joint(Surface({.capacity = capacity}),
                                          Perfect<S>({.strength = S(strength)}),
                                          TravelLimit<S>({.limit = S(limit)}), parameters));
    std::vector<typename Joint::Rows> rows(joints);
    std::vector<typename Joint::Step> steps(joints);
    for (auto _ : state) {
        for (std::size_t i = 0; i < joints; ++i) {
            rows[i] = bank[i].prepare(
                {Vector::Zero(), Vector::Constant(memory.velocity[i]), mass}, S(step));
        }
        benchmark::ClobberMemory();
        for (std::size_t i = 0; i < joints; ++i) {
            const bool flows = memory.velocity[i] != 0;
            const bool forwards = memory.velocity[i] > 0;
            Vector force = S(0.1) * capacity;
            for (int axis = 0; flows && axis < 6; ++axis) {
                const auto& row = rows[i][std::size_t(axis)];
                force[axis] = forwards ? row.lower : row.upper;
            }
            steps[i] = bank[i].commit(
                {force, Vector::Constant(memory.velocity_after[i]), Vector::Zero()}, S(step));
        }
        benchmark::ClobberMemory();
    }
    for (std::size_t i = 0; i < joints; ++i) {
        if (kind == Rows::rigid &&
            (steps[i].outcome == Outcome::yielding) != (memory.velocity[i] != 0)) {
            state.SkipWithError("the joints that should yield are not those that do");
        }
    }
    report(state, joints, 0);
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->ArgNames({"joints", "yielding%"});
    for (const long joints : {100, 1000, 10000, 100000, 1000000}) {
        for (const long yielding : {0, 1, 100}) bench->Args({joints, yielding});
    }
}
void few_sizes(benchmark::internal::Benchmark* bench) {
    bench->ArgNames({"joints", "yielding%"});
    for (const long joints : {100, 10000}) {
        for (const long yielding : {0, 1, 100}) bench->Args({joints, yielding});
    }
}
void copy_sizes(benchmark::internal::Benchmark* bench) {
    bench->ArgNames({"joints"});
    for (const long joints : {100, 1000, 10000, 100000, 1000000}) bench->Args({joints});
}

BENCHMARK(scalar<float>)->Apply(sizes);
BENCHMARK(scalar<double>)->Apply(sizes);
BENCHMARK(batch<float>)->Apply(sizes);
BENCHMARK(batch<double>)->Apply(sizes);
BENCHMARK(six<float, Rows::rigid>)->Apply(few_sizes);
BENCHMARK(six<double, Rows::rigid>)->Apply(few_sizes);
BENCHMARK(six<double, Rows::elastic>)->Apply(few_sizes);
BENCHMARK(copy<float>)->Apply(copy_sizes);
BENCHMARK(copy<double>)->Apply(copy_sizes);

} // namespace

int main(int argc, char** argv) {
    std::vector<char*> arguments(argv, argv + argc);
    std::string quick = "--benchmark_min_time=0.001";
    for (char*& argument : arguments) {
        if (std::string_view(argument) == "--quick") argument = quick.data();
    }
    int count = argc;
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
    benchmark::AddCustomContext("compiler", DUCTILE_BENCH_COMPILER);
    benchmark::AddCustomContext("flags", DUCTILE_BENCH_FLAGS);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
