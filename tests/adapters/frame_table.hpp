// SPDX-License-Identifier: MIT
//
// What a default World showed of the reference problems at a frame of 1/60 s, quantity by quantity,
// for the table of default_world.md: one CSV per executable, written at its end to the path in the
// environment variable DUCTILE_DEFAULT_WORLD (no variable, no file), and joined by
// tests/features.py.
//
//   engine,precision,solver,feature,verdict,error,expected,got,parts
//
// Verdicts: features.py. `error`: of the expected value, or of the scale that the test gives where
// that is zero [-]. `parts`: of a frame, on average, those that were put back too. Included after
// the rig.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace ductile::test {

class FrameTable {
  public:
    struct Row {
        std::string feature, verdict;
        double error = 0, misplaced = 0, expected = 0, got = 0, parts = 0;
    };
    FrameTable() = default;
    FrameTable(const FrameTable&) = delete;
    FrameTable& operator=(const FrameTable&) = delete;
    ~FrameTable() {
        const char* path = std::getenv("DUCTILE_DEFAULT_WORLD");
        if (path == nullptr) return;
        std::ofstream file(path);
        file << "engine,precision,solver,feature,verdict,error,expected,got,parts\n";
        file.precision(9);
        for (const Row& row : rows_) {
            file << WorldRig::engine << ',' << (WorldRig::single ? "float" : "double")
                 << ",default World," << row.feature << ',' << row.verdict << ',' << row.error
                 << ',' << row.expected << ',' << row.got << ',' << row.parts << '\n';
        }
    }
    void add(Row row) { rows_.push_back(std::move(row)); }
    /// Of this executable.
    static FrameTable& all() {
        static FrameTable table;
        return table;
    }

  private:
    std::vector<Row> rows_;
};

/// A reference problem in a default World, in frames of 1/60 s. Its quantities are judged where it
/// ends, as then is known whether anything was said.
class Problem {
  public:
    static constexpr double frame = 1.0 / 60;
    static constexpr double right = 0.01; ///< what the World promises [-]

    explicit Problem(std::string name)
        : rig(Warn([](const std::string&) {})), name_(std::move(name)) {
        rig.world().on_event([this](const auto& event) {
            said_ = said_ || event.kind == EventKind::unreliable || event.kind == EventKind::coarse;
            if (event.kind == EventKind::broke) broke_at = event.time;
        });
    }
    Problem(const Problem&) = delete;
    Problem& operator=(const Problem&) = delete;
    ~Problem() {
        const RunReport& run = rig.world().run();
        said_ = said_ || !run.believed();
        const double parts = double(run.parts + run.rejected + run.blows) /
                             double(std::max<std::size_t>(run.frames, 1));
        for (FrameTable::Row& row : rows_) {
            if (name_.empty()) break;
            const bool close = row.error <= right;
            const char* silent = close ? "right" : row.misplaced <= right ? "part" : "wrong";
            row.verdict = !said_ ? silent : close ? "alarm" : "said";
            row.parts = parts;
            INFO(row.feature << ": " << row.got << " instead of " << row.expected);
            CHECK(row.verdict != "wrong");
            FrameTable::all().add(std::move(row));
        }
    }

    /// `before` each: forces.
    template <class Before>
    void run(double duration, const Before& before) {
        const double end = rig.world().time() + duration;
        while (rig.world().time() < end - 1e-6) {
            before();
            rig.world().step(frame);
        }
    }
    void run(double duration) {
        run(duration, [] {});
    }
    /// `misplaced`: energy that the error stands for, of all plastic work, where the quantity is a
    /// small part of the answer: the tolerance is of all plastic work.
    void quantity(const std::string& what, double got, double expected,
                  double misplaced = std::numeric_limits<double>::infinity()) {
        note(what, got, expected, std::abs(expected), misplaced);
    }
    /// Of one that is to be zero; `scale`: what counts as much.
    void nothing(const std::string& what, double got, double scale) {
        note(what, got, 0, scale, std::numeric_limits<double>::infinity());
    }

    WorldRig rig;
    double broke_at = 0; ///< time of the last break [s]

  private:
    void note(const std::string& what, double got, double expected, double scale,
              double misplaced) {
        constexpr double none = 1e9; // no number
        const double off = std::abs(got - expected) / scale;
        rows_.push_back({.feature = name_ + ": " + what,
                         .verdict = "",
                         .error = std::isfinite(off) ? off : none,
                         .misplaced = misplaced,
                         .expected = expected,
                         .got = got});
    }

    std::string name_;
    std::vector<FrameTable::Row> rows_;
    bool said_ = false;
};

} // namespace ductile::test
