// SPDX-License-Identifier: MIT
//
// How functions that are no templates are linked. The library is headers; where DUCTILE_COMPILED is
// defined, for the library's own sources and for whoever links what they make, the bodies in the .ipp
// files are compiled there once and are not seen elsewhere.
#pragma once

#ifdef DUCTILE_COMPILED
#define DUCTILE_INLINE
#else
#define DUCTILE_INLINE inline
#endif
