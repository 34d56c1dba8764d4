// SPDX-License-Identifier: MIT
//
// What does a frame with a tolerance cost where nothing happens, and where one post of many bodies
// is struck? Beside the same world without a tolerance.
//
//   locality-<engine> [--quick] [--csv FILE]
//   locality-<engine> --count HINGES STANDING TOLERANCE FRAMES      for callgrind; STANDING: as
//                     0 posts of one, 1 posts of five, 2 pairs that are awake, 3 asleep
//
// Scenes
//   intact     1000 hinges that stand, as posts of one or five pieces, awake, or between pairs of
//              boxes on a floor, awake or asleep, with a ledger or without: two worlds, with a
//              tolerance of 1 % and with none, take their frames of 1/60 s in turn; the median of
//              the ratios of pairs
//   struck     a post of five hinges among 1000 boxes on a floor, awake or asleep, hit by a ball of
//              100 kg at 5 m/s, twenty times anew: the dearest frame beside the median step of the
//              same world without a tolerance; its solves; the same scaled to 25 solves; the post
//              is also a member of 16 segments, one body until it is struck
//
// Columns of the CSV: scene,set_up,step_us,frame_us,ratio,solves,ratio_of_25.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef BENCH_ODE
#include "locality/ode_site.hpp"
#else
#include "locality/bullet_site.hpp"
#endif

namespace {

using bench::locality::Site;

class Table {
  public:
    explicit Table(const std::string& csv) {
        if (!csv.empty()) {
            file_.open(csv);
            if (!file_) throw std::invalid_argument("--csv = " + csv + ": cannot be written");
            file_ << "scene,set_up,step_us,frame_us,ratio,solves,ratio_of_25\n";
        }
        fmt::print("{:<8} {:<28} {:>10} {:>11} {:>7} {:>7} {:>12}\n", "scene", "set-up",
                   "step [us]", "frame [us]", "ratio", "solves", "ratio of 25");
    }
    void add(const std::string& scene, const std::string& set_up, double step, double time,
             double ratio, int solves, double of_25) {
        fmt::print("{:<8} {:<28} {:>10.1f} {:>11.1f} {:>7.3f} {:>7} {:>12.3f}\n", scene, set_up,
                   1e6 * step, 1e6 * time, ratio, solves, of_25);
        std::fflush(stdout);
        file_ << fmt::format("{},{},{:.2f},{:.2f},{:.4f},{},{:.4f}\n", scene, set_up, 1e6 * step,
                             1e6 * time, ratio, solves, of_25);
    }

  private:
    std::ofstream file_;
};

enum Standing { posts_of_1, posts_of_5, pairs_awake, pairs_asleep };

std::unique_ptr<Site> stand(int hinges, Standing as, double tolerance, bool ledger) {
    auto site = std::make_unique<Site>(tolerance, ledger);
    const int joints = as == posts_of_5 ? 5 : 1;
    for (int i = 0; i < hinges / joints; ++i) {
        const double x = 2 * (i % 32), z = 2 * (i / 32);
        if (as < pairs_awake) {
            site->post(x, z, joints);
        } else {
            site->pair(x, z, as == pairs_awake);
        }
    }
    return site;
}

void intact(Table& table, int hinges, Standing as, bool ledger, int frames) {
    const int before = as == pairs_asleep ? 200 : 20; // frames, to fall asleep
    const auto without = stand(hinges, as, 0, ledger), with = stand(hinges, as, 0.01, ledger);
    std::vector<double> steps, times, ratios;
    for (int i = 0; i < before + frames; ++i) {
        const double step = without->timed_step(), time = with->timed_step();
        if (i < before) continue;
        steps.push_back(step);
        times.push_back(time);
        ratios.push_back(time / step);
    }
    constexpr std::array names{"posts of 1", "posts of 5", "pairs awake", "pairs asleep"};
    table.add("intact", fmt::format("{} in {}{}", hinges, names[as], ledger ? ", ledger" : ""),
              bench::median(steps), bench::median(times), bench::median(ratios), 1, 0);
}

void struck(Table& table, int boxes, bool awake, bool member, int times) {
    const int before = awake ? 20 : 200; // frames, to fall asleep
    std::vector<double> steps, dearest, ratios, of_25, all_solves;
    int solves = 0;
    for (int k = 0; k < times; ++k) {
        Site without(0, true), with(0.01, true);
        for (Site* site : {&without, &with}) {
            site->boxes(boxes, awake);
            if (member) {
                site->member();
            } else {
                site->post(0, 0, 5);
            }
        }
        for (int i = 0; i < before; ++i) {
            (void)without.timed_step();
            (void)with.timed_step();
        }
        with.strike();
        std::vector<double> beside;
        double most = 0;
        for (int i = 0; i < 12; ++i) {
            beside.push_back(without.timed_step());
            const double time = with.timed_step();
            if (time < most) continue;
            most = time;
            solves = with.world().frame().solves();
        }
        all_solves.push_back(solves);
        const double step = bench::median(beside);
        steps.push_back(step);
        dearest.push_back(most);
        ratios.push_back(most / step);
        of_25.push_back(1 + (most / step - 1) * 25 / solves);
    }
    table.add(
        "struck",
        fmt::format("{} boxes {}{}", boxes, awake ? "awake" : "asleep", member ? ", member" : ""),
        bench::median(steps), bench::median(dearest), bench::median(ratios),
        int(bench::median(all_solves)), bench::median(of_25));
}

} // namespace

int main(int argc, char** argv) try {
    CLI::App app("Cost of a frame with a tolerance where nothing, or little, happens");
    bool quick = false;
    std::string csv;
    std::vector<double> count;
    app.add_flag("--quick", quick, "fewer frames");
    app.add_option("--csv", csv, "file to write");
    app.add_option("--count", count, "hinges, how they stand, tolerance, frames")->expected(4);
    CLI11_PARSE(app, argc, argv);
    if (!count.empty()) {
        const auto site = stand(int(count[0]), Standing(int(count[1])), count[2], true);
        for (int i = 0; i < int(count[3]); ++i) (void)site->timed_step();
        return 0;
    }
    Table table(csv);
    for (const bool ledger : {true, false}) {
        for (const Standing as : {posts_of_1, posts_of_5, pairs_awake, pairs_asleep}) {
            intact(table, 1000, as, ledger, quick ? 40 : 200);
        }
    }
    for (const bool member : {false, true}) {
        for (const bool awake : {true, false}) {
            struck(table, 1000, awake, member, quick ? 3 : 20);
        }
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
