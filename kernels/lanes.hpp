// Whether the kernels use x86-64's own instructions where its lanes need fewer of them.
//
// The portable lanes have the same bits. GLINT_PORTABLE_LANES takes them on x86-64 too, so that one
// machine tests both.
#pragma once

#if defined(__SSE2__) && !defined(GLINT_PORTABLE_LANES)
#define GLINT_SSE2
#include <emmintrin.h>
#endif
