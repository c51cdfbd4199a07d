// What the check of symbols must catch: linked into nothing.
#include <cstdlib>

void* one_block() { return std::malloc(64); }
