// A forbidden call that the check of undefined symbols must detect. It is not linked.
#include <cstdlib>

void* one_block() { return std::malloc(64); }
