// SPDX-License-Identifier: MIT
//
// A value that most never have: room for it is taken when it is given first, and stays. Until then
// it is a pointer.
#pragma once

#include <memory>
#include <utility>

namespace ductile {

/// Copies are deep. Not thread-safe.
template <class T>
class OnDemand {
  public:
    OnDemand() = default;
    OnDemand(const OnDemand& other) : value_(other.copy()) {}
    OnDemand(OnDemand&&) noexcept = default;
    OnDemand& operator=(const OnDemand& other) {
        if (value_ != nullptr && other.value_ != nullptr) {
            *value_ = *other.value_;
        } else {
            value_ = other.copy();
        }
        return *this;
    }
    OnDemand& operator=(OnDemand&&) noexcept = default;
    ~OnDemand() = default;

    void set(T value) {
        if (value_ == nullptr) {
            value_ = std::make_unique<T>(std::move(value));
        } else {
            *value_ = std::move(value);
        }
    }
    /// One that was not given yet is T's own.
    [[nodiscard]] T& made() {
        if (value_ == nullptr) value_ = std::make_unique<T>();
        return *value_;
    }
    /// Null where it was not given yet.
    [[nodiscard]] T* get() noexcept { return value_.get(); }
    [[nodiscard]] const T* get() const noexcept { return value_.get(); }
    /// Of one that was.
    [[nodiscard]] const T* operator->() const noexcept { return value_.get(); }

  private:
    [[nodiscard]] std::unique_ptr<T> copy() const {
        return value_ != nullptr ? std::make_unique<T>(*value_) : nullptr;
    }

    std::unique_ptr<T> value_;
};

} // namespace ductile
