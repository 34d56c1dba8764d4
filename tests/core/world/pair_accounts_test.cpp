// SPDX-License-Identifier: MIT
//
// What contacts brought in, pair by pair.
#include "ductile/world/pair_accounts.hpp"

#include <catch2/catch.hpp>

using ductile::PairAccounts;

namespace {

const int a = 0, b = 0, c = 0;
const PairAccounts::Pair one{&a, &b}, other{&a, &c};

} // namespace

TEST_CASE("a pair that rebounds brought nothing in, and is no excuse for another", "[energy]") {
    PairAccounts pairs;
    pairs.begin_step(true);
    pairs.book(one, 50);
    pairs.book(other, -6);
    CHECK(pairs.brought_in() == 6);
    pairs.begin_step(true);
    pairs.book(one, -40);
    pairs.book(other, 6);
    CHECK(pairs.brought_in() == 6);
}

TEST_CASE("what a pair took before it came apart is no excuse for what it brings in later",
          "[energy]") {
    PairAccounts pairs;
    pairs.begin_step(true);
    pairs.book(one, 50);
    for (const bool all : {true, false, true}) pairs.begin_step(all);
    pairs.book(one, -5);
    CHECK(pairs.brought_in() == 5);
}

TEST_CASE("a step that is taken back brought nothing in", "[energy]") {
    PairAccounts pairs;
    pairs.begin_step(true);
    pairs.book(one, 2);
    pairs.begin_step(true);
    pairs.book(one, -1);
    pairs.book(one, -4);
    pairs.book(other, -7);
    CHECK(pairs.brought_in() == 10);
    pairs.take_back(other);
    CHECK(pairs.brought_in() == 3);
    pairs.take_back();
    CHECK(pairs.brought_in() == 0);
    pairs.begin_step(true);
    pairs.book(one, -2);
    CHECK(pairs.brought_in() == 0);
}
