// Thread sanitizer suppression, linked into every user of this library in sanitized builds only.
// Debian's Cyclone DDS is not instrumented: the sanitizer detects its accesses but not their
// synchronisation.
extern "C" const char* __tsan_default_suppressions() { return "race:libddsc.so\n"; }
