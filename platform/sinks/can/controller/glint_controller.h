/* Decoder of a tool's CAN messages and timeout machine, for a robot controller. C99, integers only:
 * neither heap nor library, and the same decisions on every processor. README.md: the rules.
 *
 * No function blocks. A glint_controller belongs to one thread: all calls come from it. */
#ifndef GLINT_CONTROLLER_H
#define GLINT_CONTROLLER_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  uint32_t identifier; /* 11 bits */
  bool fd;
  uint8_t length; /* bytes of data */
  const uint8_t* data;
} glint_frame;

/* One estimate: all values of one tick. */
typedef struct {
  int32_t position_um[3];
  int32_t rotation[4];         /* quaternion x, y, z, w; 2^30 is 1 */
  int16_t velocity[3];         /* of the tip, 0.1 mm/s */
  int16_t angular_velocity[3]; /* 1 mrad/s */
  uint16_t sigma_position;     /* an axis, 0.01 mm; the largest value: this or more, or unknown */
  uint16_t sigma_orientation;  /* 0.01 deg, likewise */
  uint16_t age;                /* of the measurement when sent, 0.1 ms; 0xFFFF: unknown */
  uint16_t registration_rms;   /* 0.1 mm; the largest value: this or more, or unknown */
  uint8_t state;               /* GLINT_STATE_... of glint_can_layout.h */
  uint8_t registration;
  uint8_t markers;
  uint8_t buttons;
  uint8_t counter;
  bool has_position; /* false: none, or it does not fit its field */
  bool has_rotation;
} glint_set;

typedef struct {
  uint32_t base;         /* identifier of the tool's first message: [can] base_id + 16 x tool */
  bool fd;               /* [can] frames = "fd" */
  uint32_t cycle_us;     /* 1e6 / tick_hz */
  uint32_t speed_max;    /* of the tip along an axis, mm/s, at most 1000000 */
  uint32_t age_max;      /* of a usable measurement, 0.1 ms: 1000 */
  uint32_t measured_max; /* longest time without state `measured`, us: 100000 */
  uint32_t heartbeat;    /* its identifier, 0x700 + [can] node; 0: heartbeats are ignored */
} glint_settings;

typedef enum {
  GLINT_IGNORED, /* another identifier */
  GLINT_PARTIAL, /* a correct frame; its set is not complete */
  GLINT_ACCEPTED,
  GLINT_WRONG_FORMAT, /* length, classic or FD */
  GLINT_WRONG_CHECK,  /* checksum, or a counter that is never sent */
  GLINT_INCOMPLETE,   /* the next set began before this one was complete */
  GLINT_REPEATED,     /* the counter of the last set */
  GLINT_JUMPED,       /* not 1 to 3 sets after the last one, or too soon for it; see README.md */
  GLINT_NO_POSE,      /* neither measured nor predicted, or out of range */
  GLINT_TOO_OLD,
  GLINT_IMPLAUSIBLE,  /* a step of the position beyond speed_max and 3 standard deviations */
  GLINT_NODE_STOPPED, /* a heartbeat "stopped": Glint restarted after a crash, or had to stop */
  GLINT_VERDICTS
} glint_verdict;

typedef enum {
  GLINT_FOLLOW, /* glint_controller.accepted is the pose to follow */
  GLINT_RAMP,   /* hold the last pose, ramp the speed down */
  GLINT_STOP    /* controlled stop; only glint_enable ends it */
} glint_action;

typedef struct {
  uint64_t received_us;
  uint8_t counter;
  uint8_t sets; /* 0: none yet */
} glint_sequence;

typedef struct {
  glint_settings settings;
  glint_set accepted;             /* the newest accepted set */
  uint64_t accepted_us;           /* when it was received */
  uint64_t measured_us;           /* when the newest accepted set of state `measured` was */
  uint32_t count[GLINT_VERDICTS]; /* of verdicts; GLINT_INCOMPLETE counts sets */
  bool enabled;
  /* The rest is internal. */
  bool any_accepted;
  bool any_measured;
  glint_sequence sequence;
  glint_sequence other; /* begun by sets that do not continue `sequence` */
  uint8_t pending;      /* bit i: classic message i of `building` was received */
  glint_set building;
} glint_controller;

/* Checks format and protection of one frame and writes its values into `set` (glint_decode.c).
 * `message` is identifier - base. Returns GLINT_PARTIAL, GLINT_WRONG_FORMAT, GLINT_WRONG_CHECK or,
 * for a message that is none of a pose, GLINT_IGNORED; all but the first leave `set` as it was. */
glint_verdict glint_decode(const glint_frame* frame, uint32_t message, glint_set* set);

/* Timeout machine (glint_follow.c). Begins stopped. */
void glint_init(glint_controller* controller, const glint_settings* settings);

/* For each received frame; now_us: monotonic time. Returns GLINT_INCOMPLETE only by `count`. */
glint_verdict glint_receive(glint_controller* controller, const glint_frame* frame,
                            uint64_t now_us);

/* Once a cycle of the controller. */
glint_action glint_cycle(glint_controller* controller, uint64_t now_us);

/* By a person, never by a program. Returns false, and stays stopped, without a current set of state
 * `measured`. */
bool glint_enable(glint_controller* controller, uint64_t now_us);

#ifdef __cplusplus
}
#endif

#endif
