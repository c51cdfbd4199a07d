// Macro for clang's nonblocking attribute: the function neither blocks nor allocates, and calls
// only functions that do not either.
//
// Clang from version 20 checks it with -Wfunction-effects; for other compilers the macro is empty.
// It follows noexcept on functions declared in a header and defined elsewhere; clang infers it for
// inline functions.
#pragma once

#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define GLINT_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef GLINT_NONBLOCKING
#define GLINT_NONBLOCKING
#endif
