// SPDX-License-Identifier: MIT
//
// Frames as chance makes them (reference problem P43): plane or in three dimensions, one to three
// storeys of one or two bays, members of four kinds of section, beams that carry something, some of
// them in two pieces; in some one column has no foot, a brace, or a beam that sticks out.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "ductile/material/named.hpp"
#include "ductile/section/box.hpp"
#include "ductile/section/i_section.hpp"
#include "ductile/section/rectangle.hpp"
#include "ductile/section/tube.hpp"
#include "ductile/structure/structure_model.hpp"

namespace ductile::test {

class RandomFrame {
  public:
    explicit RandomFrame(std::uint32_t seed, bool elastic, bool collides = false)
        : next_(seed), model_({.elastic = elastic}), collides_(collides) {
        const int kind = one_of(5), storeys = 1 + one_of(3), bays = 1 + one_of(2);
        const int rows = kind < 2 ? 1 : 2 + one_of(2); // of frames, one behind the other
        const double height = between(2.5, 4.5), length = between(3, 8), depth = between(3, 6);
        const Kind column{one_of(4), between(0.7, 1.3)}, beam{one_of(4), between(0.7, 1.3)};
        at_.resize(std::size_t(storeys) + 1);
        for (int k = 0; k <= storeys; ++k) {
            for (int i = 0; i <= bays; ++i) {
                for (int j = 0; j < rows; ++j) {
                    const double off = k > 0 && kind == 4 ? between(-0.3, 0.3) : 0;
                    at_[std::size_t(k)].push_back(
                        model_.node({length * i + off, depth * j, height * k}));
                }
            }
        }
        rows_ = rows;
        bool hangs = false;
        for (int i = 0; i <= bays; ++i) {
            for (int j = 0; j < rows; ++j) {
                if (!hangs && (bays + 1) * rows >= 3 && one_of(6) == 0) {
                    hangs = true;
                } else {
                    model_.support(at(0, i, j));
                }
            }
        }
        for (int k = 0; k < storeys; ++k) {
            for (int i = 0; i <= bays; ++i) {
                for (int j = 0; j < rows; ++j) add(at(k, i, j), at(k + 1, i, j), column, false);
            }
            for (int i = 0; i <= bays; ++i) {
                for (int j = 0; j < rows; ++j) {
                    if (i < bays) add(at(k + 1, i, j), at(k + 1, i + 1, j), beam, true);
                    if (j + 1 < rows) add(at(k + 1, i, j), at(k + 1, i, j + 1), beam, true);
                }
            }
            if (kind == 3 && one_of(2) == 0) add(at(k, 0, 0), at(k + 1, 1, 0), {1, 0.6}, false);
        }
        if (kind == 1) {
            const NodeId end = model_.node({length * bays + between(1, 3), 0, height * storeys});
            add(at(storeys, bays, 0), end, beam, true);
        }
    }

    [[nodiscard]] const StructureModel& model() const { return model_; }

  private:
    struct Kind {
        int section;
        double scale;
    };
    // the library's distributions differ from one to the other
    double between(double low, double high) {
        return low + (high - low) * (double(next_()) / 4294967296.0);
    }
    int one_of(int count) { return int(between(0, count)); }

    [[nodiscard]] NodeId at(int storey, int bay, int row) const {
        return at_[std::size_t(storey)][std::size_t(bay * rows_ + row)];
    }

    void add(NodeId from, NodeId to, const Kind& kind, bool beam) {
        MemberOptions options{.gap = collides_ ? 0.03 : 0, .collides = collides_};
        if (beam) {
            options.carried_mass = between(500, 6000);
            if (one_of(3) == 0) options.setback = 0.1;
            if (one_of(4) == 0) options.offset = {0, 0, -0.15};
        }
        if (one_of(4) == 0) options.pieces = 2;
        if (one_of(3) == 0) options.joint_length = between(0.1, 0.5);
        const std::string name = std::to_string(members_++);
        const double s = kind.scale;
        const auto member = [&](const auto& section) {
            model_.member(name, from, to, section, Material<double>(s355<double>()), options);
        };
        if (kind.section == 0) {
            member(ISection<double>({.width = 0.15 * s,
                                     .height = 0.3 * s,
                                     .web_thickness = 0.0071 * s,
                                     .flange_thickness = 0.0107 * s}));
        } else if (kind.section == 1) {
            member(Tube<double>({.outer_radius = 0.1 * s, .inner_radius = 0.092 * s}));
        } else if (kind.section == 2) {
            member(Box<double>({.width = 0.2 * s,
                                .height = 0.25 * s,
                                .web_thickness = 0.008 * s,
                                .flange_thickness = 0.01 * s}));
        } else {
            member(Rectangle<double>({.width = 0.08 * s, .height = 0.12 * s}));
        }
    }

    std::mt19937 next_;
    StructureModel model_;
    std::vector<std::vector<NodeId>> at_;
    bool collides_;
    int rows_ = 1, members_ = 0;
};

/// P43, of tests/reference/limit_load.py.
struct LimitLoad {
    std::uint32_t seed;
    double factor; ///< of the weights
};
inline constexpr LimitLoad limit_loads[] = {
    {0, 6.5455},  {1, 5.9944},  {2, 1.3356},  {3, 3.3936},   {4, 2.1229},  {5, 2.6402},
    {6, 8.4721},  {7, 56.2338}, {8, 0.3767},  {9, 9.5893},   {10, 1.1865}, {11, 14.4832},
    {12, 4.3634}, {13, 4.6861}, {14, 9.5653}, {15, 3.1126},  {16, 1.5329}, {17, 2.5527},
    {18, 4.9647}, {19, 1.9181}, {20, 5.8736}, {21, 27.5771}, {22, 4.6909}, {23, 2.9095}};

} // namespace ductile::test
