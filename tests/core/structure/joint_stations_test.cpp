// SPDX-License-Identifier: MIT
#include "ductile/structure/joint_stations.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using ductile::joint_stations;
using ductile::JointSpacing;
using ductile::JointStation;

namespace {

double integral(const std::vector<JointStation>& stations, int power) {
    double sum = 0;
    for (const JointStation& s : stations) sum += s.share * std::pow(s.at, power);
    return sum;
}

} // namespace

TEST_CASE("Stations integrate as exactly as the rule that is named", "[structure]") {
    constexpr double round_off = 1e-13;
    for (const bool start : {false, true}) {
        for (const bool end : {false, true}) {
            for (const int pieces : {1, 2, 3, 4, 7, 20, 60}) {
                const auto stations = joint_stations(pieces, start, end, JointSpacing::gauss);
                const int n = pieces - 1 + int(start) + int(end);
                REQUIRE(int(stations.size()) == n);
                if (n == 0) continue;
                const int exact = 2 * n - 1 - int(start) - int(end);
                for (int power = 0; power <= exact; ++power) {
                    CHECK(integral(stations, power) ==
                          Approx(1.0 / (power + 1)).epsilon(0).margin(round_off));
                }
                if (exact < 12) { // beyond it is not
                    CHECK(std::abs(integral(stations, exact + 1) - 1.0 / (exact + 2)) > 1e-12);
                }
                for (const JointStation& s : stations) CHECK(s.share > 0);
                CHECK((stations.front().at == 0) == start);
                CHECK((stations.back().at == 1) == end);
                for (std::size_t i = 1; i < stations.size(); ++i) {
                    CHECK(stations[i].at > stations[i - 1].at);
                }
            }
        }
    }
}

TEST_CASE("Two pieces between jointed ends are Simpson's rule, from one end Radau's",
          "[structure]") {
    const auto simpson = joint_stations(2, true, true, JointSpacing::gauss);
    CHECK(simpson[0].share == Approx(1.0 / 6));
    CHECK(simpson[1].at == Approx(0.5));
    CHECK(simpson[1].share == Approx(2.0 / 3));
    CHECK(simpson[2].share == Approx(1.0 / 6));
    const auto radau = joint_stations(2, true, false, JointSpacing::gauss);
    CHECK(radau[0].share == Approx(0.25));
    CHECK(radau[1].at == Approx(2.0 / 3));
    CHECK(radau[1].share == Approx(0.75));
}

TEST_CASE("Joints between pieces of one length stand for their halves", "[structure]") {
    const auto both = joint_stations(4, true, true, JointSpacing::equal);
    REQUIRE(both.size() == 5);
    CHECK(both[0] == JointStation{0, 0.125});
    CHECK(both[1] == JointStation{0.25, 0.25});
    CHECK(both[4] == JointStation{1, 0.125});
    const auto root = joint_stations(4, true, false, JointSpacing::equal);
    REQUIRE(root.size() == 4);
    CHECK(root[3] == JointStation{0.75, 0.375}); // the last piece has no joint at its end
    const auto tip = joint_stations(4, false, true, JointSpacing::equal);
    REQUIRE(tip.size() == 4);
    CHECK(tip[0] == JointStation{0.25, 0.375});
    CHECK(joint_stations(1, false, false, JointSpacing::equal).empty());
}
