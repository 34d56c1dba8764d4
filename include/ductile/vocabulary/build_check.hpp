// SPDX-License-Identifier: MIT
//
// Refuses builds in which the library cannot keep its word. Missing parameters are NaN until a
// constructor finds them, and infinity means "no limit": a compiler that is told that neither exists
// removes the checks and the limits. That is -ffast-math and -Ofast (GCC, Clang), -ffinite-math-only
// alone, and /fp:fast (MSVC).
#pragma once

#if defined(__FAST_MATH__)
#error "ductile: -ffast-math (or -Ofast) removes the checks for NaN and infinity; build without it"
#elif defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error "ductile: -ffinite-math-only removes the checks for NaN and infinity; build without it"
#elif defined(_M_FP_FAST)
#error "ductile: /fp:fast removes the checks for NaN and infinity; build with /fp:precise"
#endif
