// SPDX-License-Identifier: MIT
#include "ductile/vocabulary/on_demand.hpp"

#include <catch2/catch.hpp>
#include <utility>

using ductile::OnDemand;

namespace {
struct Value {
    int number = 7;
};
static_assert(sizeof(OnDemand<Value>) == sizeof(void*));
} // namespace

TEST_CASE("A value on demand is there once it is given, and its copies are their own",
          "[vocabulary]") {
    OnDemand<Value> none, value;
    CHECK(none.get() == nullptr);
    CHECK(none.made().number == 7);
    value.set({3});
    const Value* room = value.get();
    value.set({4});
    CHECK(value.get() == room);

    OnDemand<Value> copy(value);
    CHECK(copy->number == 4);
    copy.made().number = 5;
    CHECK(value->number == 4);
    value = copy; // into the room that it has
    CHECK(value->number == 5);
    CHECK(value.get() == room);
    value = OnDemand<Value>();
    CHECK(value.get() == nullptr);
    value = std::as_const(copy);
    CHECK(value->number == 5);
    copy = OnDemand<Value>(none);
    CHECK(copy->number == 7);
}
