// guest_exit STATUS: ends an emulated machine; STATUS becomes the emulator's exit status.
#include <stdlib.h>

#include "semihosting.h"

int main(int count, char** arguments) {
  unsigned long block[2] = {k_stopped_application_exit,
                            count > 1 ? strtoul(arguments[1], 0, 10) : 0};
  semihosting_call(k_sys_exit, block);
  return 1;  // only without semihosting
}
