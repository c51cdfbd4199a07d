// Built into whatever links this room, in thread-sanitized builds only. Debian's Cyclone DDS is not
// built with the sanitizer, which therefore sees its accesses but not what orders them.
extern "C" const char* __tsan_default_suppressions() { return "race:libddsc.so\n"; }
