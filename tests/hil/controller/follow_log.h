/* A controller that receives a CAN log: its decisions as text, the same on every processor. */
#ifndef GLINT_FOLLOW_LOG_H
#define GLINT_FOLLOW_LOG_H

#include <stdint.h>

#include "../../../platform/sinks/can/controller/glint_controller.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
  FOLLOW_END = 0,     /* of the log */
  FOLLOW_ENABLE = 1,  /* a person enables the motion */
  FOLLOW_RESTART = 2, /* the controller starts again */
} follow_event;

/* A robot controller that calls glint_cycle at fixed times. */
typedef struct {
  glint_controller controller;
  void (*put)(const char* text); /* receives each line's parts */
  uint64_t next_cycle_us;
  uint64_t hash; /* of the accepted sets */
  uint32_t enable_cycles;
  uint32_t stopped_cycles;
  int action; /* of the last cycle; -1: none yet */
} follower;

/* enable_cycles: a person enables that many cycles after a stop; 0: only by FOLLOW_ENABLE. */
void follow_begin(follower* f, const glint_settings* settings, uint64_t first_cycle_us,
                  uint32_t enable_cycles, void (*put)(const char* text));
/* Each call first runs the cycles before now_us. Times do not decrease. */
void follow_frame(follower* f, const glint_frame* frame, uint64_t now_us);
void follow_at(follower* f, follow_event event, uint64_t now_us);

/* `log`: settings, then frames and events, as pack_log.py writes them. */
void follow_log(const uint8_t* log, void (*put)(const char* text));

#ifdef __cplusplus
}
#endif

#endif
