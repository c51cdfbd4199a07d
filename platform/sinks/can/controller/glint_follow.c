/* Collects the frames of a set, accepts or rejects it, and decides: follow, ramp down or stop. */
#include "glint_can_layout.h"
#include "glint_controller.h"

#define GLINT_CLASSIC_COUNTERS 15
#define GLINT_FD_COUNTERS 256
#define GLINT_ADVANCE_MAX 3
#define GLINT_NEW_SEQUENCE 3 /* sets in order that replace a broken sequence */
#define GLINT_ALL_CLASSIC 0x1F
#define GLINT_RAMP_CYCLES 3
#define GLINT_STOP_CYCLES 5
#define GLINT_STOP_US 20000

static void clear(void* object, uint32_t bytes) {
  volatile uint8_t* const byte = object; /* else a compiler makes it a call of memset */
  for (uint32_t i = 0; i < bytes; ++i) byte[i] = 0;
}

void glint_init(glint_controller* controller, const glint_settings* settings) {
  clear(controller, sizeof *controller);
  controller->settings = *settings;
}

static bool is_plausible(const glint_controller* c, const glint_set* set, uint64_t now_us) {
  const uint64_t second = 1000000;
  const uint64_t elapsed = now_us - c->accepted_us;
  /* mm/s x us / 1000 = um. After a second nothing restricts the step but the tip's range. */
  const uint64_t moved =
      (uint64_t)c->settings.speed_max * (elapsed < second ? elapsed : second) / 1000;
  const int64_t allowed = (int64_t)moved + 3 * 10 * (int64_t)set->sigma_position;
  if (!c->any_accepted || elapsed >= second) return true;
  for (int i = 0; i < 3; ++i) {
    const int64_t step = (int64_t)set->position_um[i] - c->accepted.position_um[i];
    if (step > allowed || -step > allowed) return false;
  }
  return true;
}

/* Whether `counter` continues a sequence: 1 to 3 sets on, and not faster than they are sent. Sets
 * that a gateway delivers late and at once are too fast. */
static bool continues(const glint_controller* c, const glint_sequence* sequence, uint8_t counter,
                      uint64_t now_us) {
  const unsigned counters = c->settings.fd ? GLINT_FD_COUNTERS : GLINT_CLASSIC_COUNTERS;
  const unsigned advance = (counter + counters - sequence->counter) % counters;
  const uint64_t fastest = (2 * (uint64_t)advance - 1) * c->settings.cycle_us;
  return sequence->sets > 0 && advance >= 1 && advance <= GLINT_ADVANCE_MAX &&
         2 * (now_us - sequence->received_us) >= fastest;
}

/* A single set that is late or early does not end the sequence; three in order begin another. */
static bool in_sequence(glint_controller* c, uint8_t counter, uint64_t now_us) {
  const bool follows = continues(c, &c->sequence, counter, now_us);
  if (!follows) {
    c->other.sets = continues(c, &c->other, counter, now_us) ? c->other.sets + 1 : 1;
    c->other.counter = counter;
    c->other.received_us = now_us;
    if (c->other.sets < GLINT_NEW_SEQUENCE) return false;
  }
  c->sequence.counter = counter;
  c->sequence.received_us = now_us;
  c->sequence.sets = 1;
  c->other.sets = 0;
  return true;
}

static glint_verdict judge(glint_controller* c, uint64_t now_us) {
  const glint_set* const set = &c->building;
  if (c->sequence.sets > 0 && set->counter == c->sequence.counter) return GLINT_REPEATED;
  if (!in_sequence(c, set->counter, now_us)) return GLINT_JUMPED;
  const bool usable = set->state == GLINT_STATE_MEASURED || set->state == GLINT_STATE_PREDICTED;
  if (!usable || !set->has_position || !set->has_rotation) return GLINT_NO_POSE;
  if (set->age > c->settings.age_max) return GLINT_TOO_OLD;
  if (!is_plausible(c, set, now_us)) return GLINT_IMPLAUSIBLE;
  c->accepted = *set;
  c->accepted_us = now_us;
  c->any_accepted = true;
  if (set->state == GLINT_STATE_MEASURED) {
    c->measured_us = now_us;
    c->any_measured = true;
  }
  return GLINT_ACCEPTED;
}

/* A heartbeat has no checksum: it may stop the motion, and never starts it. */
static glint_verdict heartbeat(glint_controller* c, const glint_frame* frame) {
  if (frame->fd || frame->length != GLINT_HEARTBEAT_BYTES) return GLINT_WRONG_FORMAT;
  if (frame->data[0] != GLINT_NODE_STATE_STOPPED) return GLINT_IGNORED;
  c->enabled = false;
  return GLINT_NODE_STOPPED;
}

static glint_verdict receive(glint_controller* c, const glint_frame* frame, uint64_t now_us) {
  const uint32_t message = frame->identifier - c->settings.base;
  glint_set next = c->building;
  if (c->settings.heartbeat != 0 && frame->identifier == c->settings.heartbeat)
    return heartbeat(c, frame);
  if (frame->identifier < c->settings.base || (message == GLINT_POSE_FD_OFFSET) != c->settings.fd)
    return GLINT_IGNORED;
  const glint_verdict verdict = glint_decode(frame, message, &next);
  if (verdict != GLINT_PARTIAL) return verdict;
  if (c->pending != 0 && next.counter != c->building.counter) {
    ++c->count[GLINT_INCOMPLETE];
    c->pending = 0;
  }
  c->building = next;
  if (!c->settings.fd) {
    c->pending = (uint8_t)(c->pending | 1U << message);
    if (c->pending != GLINT_ALL_CLASSIC) return GLINT_PARTIAL;
    c->pending = 0;
  }
  return judge(c, now_us);
}

glint_verdict glint_receive(glint_controller* controller, const glint_frame* frame,
                            uint64_t now_us) {
  const glint_verdict verdict = receive(controller, frame, now_us);
  ++controller->count[verdict];
  return verdict;
}

static bool is_current(const glint_controller* c, uint64_t now_us) {
  const uint64_t cycles = (uint64_t)GLINT_STOP_CYCLES * c->settings.cycle_us;
  const uint64_t limit = cycles > GLINT_STOP_US ? cycles : GLINT_STOP_US;
  return c->any_measured && now_us - c->accepted_us < limit &&
         now_us - c->measured_us < c->settings.measured_max;
}

glint_action glint_cycle(glint_controller* controller, uint64_t now_us) {
  const uint64_t missed = (uint64_t)GLINT_RAMP_CYCLES * controller->settings.cycle_us;
  if (!is_current(controller, now_us)) controller->enabled = false;
  if (!controller->enabled) return GLINT_STOP;
  return now_us - controller->accepted_us > missed ? GLINT_RAMP : GLINT_FOLLOW;
}

bool glint_enable(glint_controller* controller, uint64_t now_us) {
  controller->enabled = is_current(controller, now_us);
  return controller->enabled;
}
