// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "ductile/world/ledger.hpp"

using namespace ductile;

TEST_CASE("what no entry names is unexplained", "[energy]") {
    Ledger<double> ledger;
    ledger.open({.kinetic = 100, .potential = 20, .elastic = 5});
    ledger.supply(10);
    ledger.book(Account::plastic, 60);
    ledger.book(Account::friction, 15);
    ledger.book(Account::friction, -5);
    ledger.update({.kinetic = 40, .potential = 20, .elastic = 2});
    CHECK(ledger.booked(Account::friction) == 10);
    CHECK(ledger.unexplained() == Approx(135 - 62 - 70));
    ledger.open(ledger.held());
    CHECK(ledger.unexplained() == 0);
    CHECK(ledger.booked(Account::plastic) == 0);
}

TEST_CASE("accounts have names", "[energy]") {
    CHECK(to_string(Account::plastic) == "plastic");
    CHECK(to_string(Account::friction) == "friction");
    CHECK(to_string(Account::contact) == "contact");
    CHECK(to_string(Account::joints) == "joints");
    CHECK(to_string(Account::integration) == "integration");
    CHECK(to_string(Account::vibration) == "vibration");
    CHECK(to_string(Account::count) == "unknown");
}
