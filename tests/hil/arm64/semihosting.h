// Calls to the emulator that runs this machine, which has to have been started with
// -semihosting-config enable=on,userspace=on,target=native.
// Source: Arm, "Semihosting for AArch32 and AArch64", section 2.
#pragma once

enum {
  k_sys_open = 0x01,
  k_sys_close = 0x02,
  k_sys_write0 = 0x04,
  k_sys_write = 0x05,
  k_sys_exit = 0x18
};
enum { k_open_write_binary = 5, k_stopped_application_exit = 0x20026 };

static long semihosting_call(unsigned long operation, void* block) {
  register unsigned long result __asm__("x0") = operation;
  register void* parameter __asm__("x1") = block;
  __asm__ volatile("hlt #0xf000" : "+r"(result) : "r"(parameter) : "memory");
  return (long)result;
}
