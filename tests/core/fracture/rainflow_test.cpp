// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <rapidcheck/catch.h>
#include <vector>

#include "ductile/fracture/rainflow.hpp"

using namespace ductile;

namespace {

using Counts = std::map<double, double>; // range -> cycles

/// ASTM E1049-85, section 5.4.4, word by word on a list of points: the oracle.
Counts astm(const std::vector<double>& history) {
    std::vector<double> points; // peaks and valleys
    for (const double p : history) {
        if (!points.empty() && p == points.back()) continue;
        if (points.size() >= 2 &&
            (points.back() - points[points.size() - 2]) * (p - points.back()) > 0) {
            points.back() = p;
        } else {
            points.push_back(p);
        }
    }
    Counts counts;
    std::vector<double> read;
    for (const double p : points) {
        read.push_back(p);
        while (read.size() >= 3) {
            const std::size_t n = read.size();
            const double x = std::abs(read[n - 1] - read[n - 2]);
            const double y = std::abs(read[n - 2] - read[n - 3]);
            if (x < y) break;
            if (n == 3) { // Y contains the starting point
                counts[y] += 0.5;
                read.erase(read.begin());
            } else {
                counts[y] += 1;
                read.erase(read.end() - 3, read.end() - 1);
            }
        }
    }
    for (std::size_t i = 1; i < read.size(); ++i) counts[std::abs(read[i] - read[i - 1])] += 0.5;
    return counts;
}

template <class S = double, std::size_t Capacity = 16>
struct Counter {
    Rainflow<S, Capacity> rainflow;
    Counts settled;

    void add(double increment) {
        rainflow.add(S(increment),
                     [&](S range, S cycles) { settled[double(range)] += double(cycles); });
    }
    [[nodiscard]] Counts counts() const {
        Counts all = settled;
        rainflow.residue([&](S range, S cycles) { all[double(range)] += double(cycles); });
        return all;
    }
};

template <class S = double, std::size_t Capacity = 16>
Counts stream(const std::vector<double>& history, int split = 1) {
    Counter<S, Capacity> counter;
    for (std::size_t i = 1; i < history.size(); ++i) {
        for (int k = 0; k < split; ++k) counter.add((history[i] - history[i - 1]) / split);
    }
    return counter.counts();
}

} // namespace

TEST_CASE("rainflow counts the worked example of ASTM E1049-85", "[fracture][rainflow]") {
    const std::vector<double> example{-2, 1, -3, 5, -1, 3, -4, 4, -2};
    const Counts expected{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}};
    CHECK(stream(example) == expected);
    CHECK(stream<float>(example) == expected);
    CHECK(stream(example, 8) == expected); // eighths are exact
    auto mirrored = example;
    for (double& p : mirrored) p = -p;
    CHECK(stream(mirrored) == expected);
    CHECK(astm(example) == expected);
}

TEST_CASE("small cycles nested in a big one are counted, and the big one as if they were not there",
          "[fracture][rainflow]") {
    // up to 10 with two loops of 3 and one of 1 inside the first of them, then down to 0
    CHECK(stream({0, 5, 2, 4, 3, 6, 3, 10, 0}) == Counts{{1, 1}, {3, 2}, {10, 1}});
}

TEST_CASE("rainflow remembers turning points through a whole tree of loops",
          "[fracture][rainflow]") {
    // converging, then one sweep that closes all
    CHECK(stream({0, 10, 1, 9, 2, 8, 3, 7, 4, 20}) ==
          Counts{{3, 1}, {5, 1}, {7, 1}, {9, 1}, {20, 0.5}});
}

TEST_CASE("rainflow equals the ASTM procedure on any history of integers", "[fracture][rainflow]") {
    rc::prop("same ranges, same counts, after every point",
             [](const std::vector<signed char>& raw) {
                 std::vector<double> history{0};
                 Counter<double, 200> counter;
                 for (const signed char p : raw) {
                     counter.add(p - history.back());
                     history.push_back(p);
                     RC_ASSERT(counter.counts() == astm(history));
                 }
             });
    // long ones, and in float
    std::mt19937 random(1);
    std::uniform_int_distribution<int> level(-1000, 1000);
    std::vector<double> history{0};
    for (int i = 0; i < 20'000; ++i) history.push_back(level(random));
    const Counts expected = astm(history);
    CHECK((stream<double, 64>(history) == expected)); // in brackets: thousands of entries
    CHECK((stream<float, 64>(history) == expected));
}

TEST_CASE("constant amplitude needs one open range and settles half a cycle per turn",
          "[fracture][rainflow]") {
    Counter<double, 2> counter;
    for (int i = 0; i < 1001; ++i) {
        counter.add(i % 2 ? -4 : 4);
        REQUIRE(counter.rainflow.depth() <= 1);
    }
    CHECK(counter.counts() == Counts{{4, 500.5}});
}

TEST_CASE("sixteen open ranges hold a long random walk, and nearly hold white noise",
          "[fracture][rainflow]") {
    std::mt19937 random(2);
    std::normal_distribution<double> noise;
    Rainflow<double> walk;
    Rainflow<double> level;
    Rainflow<double, 64> deep_level;
    std::size_t deepest_walk = 0;
    std::size_t deepest_level = 0;
    double shallow_sum = 0;
    double deep_sum = 0;
    double last = 0;
    const auto add_to = [](double& sum) {
        return [&sum](double range, double cycles) { sum += cycles * std::pow(range, 1.67); };
    };
    for (int i = 0; i < 100'000; ++i) {
        walk.add(noise(random), [](double, double) {});
        deepest_walk = std::max(deepest_walk, walk.depth());
        const double next = noise(random);
        level.add(next - last, add_to(shallow_sum));
        deep_level.add(next - last, add_to(deep_sum));
        deepest_level = std::max(deepest_level, deep_level.depth());
        last = next;
    }
    level.residue(add_to(shallow_sum));
    deep_level.residue(add_to(deep_sum));
    CHECK(deepest_walk < 16);
    CHECK(deepest_level > 16); // so that the stack of 16 was full
    CHECK(shallow_sum >= deep_sum * (1 - 1e-12));
    CHECK(shallow_sum <= deep_sum * (1 + 1e-3));
}

TEST_CASE("a full stack never counts less than a deep one", "[fracture][rainflow]") {
    rc::prop("sum of range^m, for m from 0.5 to 12, after every increment",
             [](const std::vector<signed char>& raw) {
                 Counter<double, 2> shallow;
                 Counter<double, 3> middle;
                 Counter<double, 200> deep;
                 for (const signed char step : raw) {
                     shallow.add(step);
                     middle.add(step);
                     deep.add(step);
                     for (const double m : {0.5, 1.0, 1.67, 12.0}) {
                         const auto sum = [m](const Counts& counts) {
                             double total = 0;
                             for (const auto& [range, n] : counts) total += n * std::pow(range, m);
                             return total * (1 + 1e-12);
                         };
                         const double least = sum(deep.counts()) * (1 - 1e-12);
                         RC_ASSERT(sum(middle.counts()) >= least);
                         RC_ASSERT(sum(shallow.counts()) >= least);
                     }
                 }
             });
}

TEST_CASE("a full stack overestimates a slowly converging history by little",
          "[fracture][rainflow]") {
    // ranges 1000, 999, ... 801: none closes, so 200 stay open; 16 of them are kept
    Counter<double, 16> shallow;
    Counter<double, 255> deep;
    double sign = 1;
    for (int range = 1000; range > 800; --range, sign = -sign) {
        shallow.add(sign * range);
        deep.add(sign * range);
        REQUIRE(shallow.rainflow.depth() <= 16);
    }
    const auto sum = [](const Counts& counts) {
        double total = 0;
        for (const auto& [range, n] : counts) total += n * std::pow(range, 1.67);
        return total;
    };
    CHECK(deep.rainflow.depth() == 199);
    CHECK(sum(shallow.counts()) > sum(deep.counts()));
    CHECK(sum(shallow.counts()) < sum(deep.counts()) * 1.01);
}

TEST_CASE("rainflow keeps the digits of small increments in float", "[fracture][rainflow]") {
    Counter<float> counter;
    for (int i = 0; i < 1'000'000; ++i) counter.add(1e-8F); // half an ulp of the sum at its end
    CHECK(counter.rainflow.running() == Approx(0.01).epsilon(1e-6));
}
