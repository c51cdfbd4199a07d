// guest_exit STATUS: ends an emulated machine with this exit status of the emulator, which has to
// have been started with -semihosting-config enable=on,userspace=on,target=native.
// Source: Arm, "Semihosting for AArch32 and AArch64", SYS_EXIT (0x18), ADP_Stopped_ApplicationExit.
#include <stdlib.h>

int main(int count, char** arguments) {
  unsigned long block[2] = {0x20026, count > 1 ? strtoul(arguments[1], 0, 10) : 0};
  register unsigned long operation __asm__("x0") = 0x18;
  register unsigned long* parameter __asm__("x1") = block;
  __asm__ volatile("hlt #0xf000" : : "r"(operation), "r"(parameter) : "memory");
  return 1;  // only where nobody listens
}
