/* follow_log LOG: the decisions on this machine. */
#include <stdio.h>
#include <stdlib.h>

#include "follow_log.h"

static void put(const char* text) { fputs(text, stdout); }

int main(int count, char** arguments) {
  FILE* const file = count == 2 ? fopen(arguments[1], "rb") : NULL;
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) return 2;
  const long size = ftell(file);
  uint8_t* const log = malloc((size_t)size);
  rewind(file);
  if (log == NULL || fread(log, 1, (size_t)size, file) != (size_t)size) return 2;
  follow_log(log, put);
  free(log);
  return fclose(file) == 0 ? 0 : 2;
}
