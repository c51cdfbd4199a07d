/* An example of a producer: streams frame files to Glint through shared memory, over and over.
 *
 *   glint_example_producer SOCKET FILE...
 *
 * FILE: 512 x 512 depth, then reflectivity, 16 bits little endian, as `glint simulate --frame-files 1`
 * writes them. 45 frames a second. Ends when Glint has gone. */
#include "platform/sources/glint_frames.h"

#include <stdlib.h>
#include <time.h>

enum { SIDE = 512, PERIOD_NS = 22222222, READOUT_NS = 9000000 };

static int64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void sleep_until(int64_t ns) {
  const struct timespec time = {(time_t)(ns / 1000000000), (long)(ns % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL) != 0) {
  }
}

int main(int count, char** arguments) {
  if (count < 3) {
    fprintf(stderr, "usage: %s SOCKET FILE...\n", arguments[0]);
    return 2;
  }
  const size_t bytes = 2u * 2u * SIDE * SIDE;
  const int files = count - 2;
  char* const frames = malloc(bytes * (size_t)files);
  for (int i = 0; frames != NULL && i < files; ++i) {
    FILE* file = fopen(arguments[2 + i], "rb");
    if (file == NULL || fread(frames + bytes * (size_t)i, 1, bytes, file) != bytes) {
      fprintf(stderr, "%s: cannot be read; expected %zu bytes\n", arguments[2 + i], bytes);
      return 2;
    }
    fclose(file);
  }
  struct glint_frames to_glint;
  if (frames == NULL || glint_frames_connect(&to_glint, arguments[1], SIDE, SIDE, 16) != 0) {
    fprintf(stderr, "%s: %s\n", arguments[1], to_glint.error);
    return 3;
  }
  const double at_the_origin[7] = {0, 0, 0, 0, 0, 0, 1};
  int64_t exposed = now_ns();
  for (int i = 0; to_glint.socket_fd >= 0; i = (i + 1) % files, exposed += PERIOD_NS) {
    sleep_until(exposed + READOUT_NS); /* as a camera would deliver it */
    uint16_t* depth = glint_frames_begin(&to_glint);
    if (depth == NULL) continue;
    memcpy(depth, frames + bytes * (size_t)i, bytes);
    glint_frames_send(&to_glint, exposed, at_the_origin);
  }
  fprintf(stderr, "%s: %s\n", arguments[1], to_glint.error);
  free(frames);
  return 0;
}
