// A promise in a function's type: it neither blocks nor allocates, and calls nothing that may.
//
// Clang from version 20 follows it with -Wfunction-effects; other compilers do not know the word.
// It stands after noexcept, on what is declared in a header and defined elsewhere: what is inline
// the compiler sees through by itself.
#pragma once

#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define GLINT_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef GLINT_NONBLOCKING
#define GLINT_NONBLOCKING
#endif
