// Selects SSE2 instructions on x86-64 where they need fewer instructions than portable SIMD lanes.
//
// Both variants have equal bits. GLINT_PORTABLE_LANES selects the portable one on x86-64 too, so
// that one machine tests both.
#pragma once

#if defined(__SSE2__) && !defined(GLINT_PORTABLE_LANES)
#define GLINT_SSE2
#include <emmintrin.h>
#endif
