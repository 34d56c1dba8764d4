// SPDX-License-Identifier: MIT
//
// The way of a driven body over frames: it goes on without a jump, ends where it should, and what a
// joint counts of it adds up to what the body went.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "ductile/world/driven_course.hpp"

using namespace ductile;

namespace {

BodyState<double> turning(double speed) {
    BodyState<double> state;
    state.spin = {0, 0, speed};
    return state;
}

struct Total {
    double counted = 0, went = 0, largest_jump = 0;
};

/// Of a body that turns as sin πt from `from` to `to` [s], in frames whose lengths come in turn.
Total over(double from, double to, std::array<double, 2> lengths) {
    DrivenCourse course;
    const auto angle = [](double t) { return std::sin(std::numbers::pi * t); };
    Total total;
    double t = 0, end = 0;
    for (std::size_t i = 0; t < to - 1e-9; ++i) {
        const double length = lengths[i % 2], next = t + length;
        course.begin(turning((angle(next) - angle(t)) / length), length);
        if (t > from - 1e-9) {
            const double start = course.spin(0).z();
            total.largest_jump = std::max(total.largest_jump, std::abs(start - end));
            const double middle = course.spin(length / 2).z(); // Simpson, exact of a parabola
            total.counted += (start + 4 * middle + course.spin(length).z()) / 6 * length;
            total.went += course.turn(length).z();
        }
        end = course.spin(length).z();
        t = next;
    }
    return total;
}

} // namespace

TEST_CASE("A driven body's travel adds up to its way, over many frames") {
    // half a turn to and a quarter beyond, so that nothing cancels
    for (const double length : {1.0 / 240, 1.0 / 60, 0.02, 1.0 / 30}) {
        CAPTURE(length);
        const Total total = over(1.5, 2.5, {length, length});
        CHECK(total.went == Approx(2).epsilon(1e-12));
        CHECK(total.largest_jump < 1e-12);
        CHECK(total.counted == Approx(total.went).epsilon(1e-12));
    }
    const Total total = over(1.5, 2.5, {0.02, 0.005});
    CHECK(total.went == Approx(2).epsilon(1e-12));
    CHECK(total.largest_jump < 1e-12);
    CHECK(total.counted == Approx(total.went).epsilon(1e-12));
}

TEST_CASE("A part's halves lead to where it ends") {
    DrivenCourse course;
    for (const double speed : {0.0, 0.1, 0.4, 1.0}) course.begin(turning(speed), 0.1);
    const double first = course.spin(0.02).z() * 0.01, second = course.later_spin(0.02, 0.02).z();
    CHECK(course.turn(0.02).z() + first + second * 0.01 ==
          Approx(course.turn(0.04).z()).epsilon(1e-12));
}

TEST_CASE("What begins smoothly jumps in its first frame alone") {
    for (const int power : {2, 3, 4}) {
        CAPTURE(power);
        DrivenCourse course;
        for (int i = 0; i < 6; ++i) {
            const double before = course.spin(0.1).z();
            course.begin(turning(std::pow(i + 1, power) - std::pow(i, power)), 0.1);
            if (i > 0) CHECK(course.spin(0).z() == before);
        }
    }
}

TEST_CASE("A smooth motion goes on where it is fastest") {
    // at t = 2 s no velocity changes; a jump there was 0.01 % of a half turn
    const Total total = over(1.5, 2.25, {1.0 / 60, 1.0 / 60});
    CHECK(total.largest_jump < 1e-12);
}

TEST_CASE("What is set into motion at once, or turned round at once, jumps") {
    DrivenCourse course;
    const auto jumps = [&course](double speed) {
        const double before = course.spin(0.01).z();
        course.begin(turning(speed), 0.01);
        return course.spin(0).z() != before;
    };
    course.begin(turning(0), 0.01);
    CHECK_FALSE(jumps(0));
    CHECK(jumps(3));
    CHECK(course.spin(0.01).z() == 3); // all the frame
    for (int i = 0; i < 5; ++i) {
        CHECK_FALSE(jumps(3));
        CHECK(course.turn(0.01).z() == Approx(0.03).epsilon(1e-14));
    }
    CHECK(jumps(-3));
    CHECK(course.spin(0.01).z() == -3);
    CHECK_FALSE(jumps(-3));
    CHECK(jumps(-3.1));
    for (int i = 2; i <= 4; ++i) CHECK_FALSE(jumps(-3 - 0.1 * i));
    CHECK(jumps(-5)); // the way that it went faster, but far more so
}

TEST_CASE("A motion that begins was misread where its first change goes on, as is told once") {
    constexpr double length = 1.0 / 30;
    const auto told = [](auto angle) { // in which frames
        DrivenCourse course;
        std::vector<int> frames;
        for (int i = 0; i < 12; ++i) {
            const double t = i * length;
            course.begin(turning((angle(t + length) - angle(t)) / length), length);
            if (course.was_misread()) frames.push_back(i);
        }
        return frames;
    };
    CHECK(told([](double t) { return 3 * t * t; }) == std::vector<int>{1});
    CHECK(told([](double t) { return 3 * t * t * t; }) == std::vector<int>{1});
    CHECK(told([](double t) { return 1 - std::cos(4 * t); }) == std::vector<int>{1});
    CHECK(told([](double t) { return 7 * t; }).empty());
    CHECK(told([](double t) { return 7 * t + t * t; }).empty());
    CHECK(told([](double t) { return t < 5.5 * length ? 0 : 7 * (t - 5.5 * length); }).size() <= 1);
    CHECK(told([](double) { return 0.0; }).empty());
}
