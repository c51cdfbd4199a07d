// guest_copy FILE...: copies files of an emulated machine by semihosting into the emulator's
// working folder, under the same names. Exit 1: a copy is incomplete.
#include <stdio.h>
#include <string.h>

#include "semihosting.h"

static int copy_to_host(const char* name) {
  static char bytes[1 << 16];
  FILE* file = fopen(name, "rb");
  if (file == NULL) return 0;
  unsigned long open[3] = {(unsigned long)name, k_open_write_binary, strlen(name)};
  const long handle = semihosting_call(k_sys_open, open);
  int complete = handle != -1;
  size_t count;
  while (complete && (count = fread(bytes, 1, sizeof bytes, file)) > 0) {
    unsigned long write[3] = {(unsigned long)handle, (unsigned long)bytes, count};
    complete =
        semihosting_call(k_sys_write, write) == 0;  // returns the number of bytes not written
  }
  complete = complete && !ferror(file);
  fclose(file);
  if (handle == -1) return 0;
  unsigned long close[1] = {(unsigned long)handle};
  return semihosting_call(k_sys_close, close) == 0 && complete;
}

int main(int count, char** arguments) {
  int result = 0;
  for (int i = 1; i < count; ++i) {
    if (copy_to_host(arguments[i])) continue;
    fprintf(stderr, "guest_give: %s is not whole on the host\n", arguments[i]);
    result = 1;
  }
  return result;
}
