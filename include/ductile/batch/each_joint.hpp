// SPDX-License-Identifier: MIT
//
// The loop of a batch over its joints, on the widest registers that the processor has.
//
// A program built for x86-64 in general may use registers of 16 bytes only. Nearly every processor
// has them of 32 (AVX2), which halves the instructions, so the loop exists twice and the processor
// is asked at run time. Both make the same operations in the same order without fused multiply-add,
// so that results do not depend on the machine. (The attribute target_clones would do the same in a
// word, but clang 14 refuses it on templates, and its resolver runs before a thread sanitiser can.)
// Elsewhere, and where the build asks for more than AVX2, the one loop is what the build makes of
// it.
//
// Two things let the loop vectorise well. `__restrict`, which all compilers know on parameters:
// without it every call would check 18 arrays against each other; check_arrays has refused
// overlaps. And that the rule is inlined whole, with no branch in it.
#pragma once

#include <cstddef>

namespace ductile::batch_detail {

/// rule(i, n, arrays...) for n in [0, joints), i = from + n. No two arrays may overlap where one is
/// written. The rule is called on a copy, which no array can alias.
template <class Rule, class... T>
void each_joint_as_built(Rule rule, std::size_t from, std::size_t joints,
                         T* __restrict... arrays) noexcept {
    for (std::size_t n = 0; n < joints; ++n) rule(from + n, n, arrays...);
}

#if defined(__x86_64__) && !defined(__AVX2__)

template <class Rule, class... T>
[[gnu::target("avx2")]] void each_joint_avx2(Rule rule, std::size_t from, std::size_t joints,
                                             T* __restrict... arrays) noexcept {
    for (std::size_t n = 0; n < joints; ++n) rule(from + n, n, arrays...);
}

template <class Rule, class... T>
void each_joint(const Rule& rule, std::size_t from, std::size_t joints, T*... arrays) noexcept {
    if (__builtin_cpu_supports("avx2")) {
        each_joint_avx2(rule, from, joints, arrays...);
    } else {
        each_joint_as_built(rule, from, joints, arrays...);
    }
}

#else

template <class Rule, class... T>
void each_joint(const Rule& rule, std::size_t from, std::size_t joints, T*... arrays) noexcept {
    each_joint_as_built(rule, from, joints, arrays...);
}

#endif

} // namespace ductile::batch_detail
