#include "follow_log.h"

#include "../../../platform/sinks/can/controller/glint_controller.h"

#define END 0xFFFFFFFFU
#define ENABLE_CYCLES 25 /* a person enables that long after a stop */

static uint64_t number_at(const uint8_t* byte, int bytes) {
  uint64_t value = 0;
  for (int i = bytes; i-- > 0;) value = value << 8 | byte[i];
  return value;
}

static void put_number(void (*put)(const char*), uint64_t value) {
  char text[21];
  int at = 20;
  text[at] = 0;
  do {
    text[--at] = (char)('0' + value % 10);
    value /= 10;
  } while (value != 0);
  put(text + at);
}

static void put_line(void (*put)(const char*), uint64_t number, const char* text) {
  put_number(put, number);
  put(" ");
  put(text);
  put("\n");
}

/* FNV-1a over the numbers of an accepted set. */
static uint64_t hashed(uint64_t hash, uint64_t value) {
  for (int i = 0; i < 8; ++i) {
    hash = (hash ^ (value & 0xFFU)) * 1099511628211U;
    value >>= 8;
  }
  return hash;
}

static uint64_t hash_of(uint64_t hash, const glint_set* set) {
  for (int i = 0; i < 3; ++i) hash = hashed(hash, (uint32_t)set->position_um[i]);
  for (int i = 0; i < 4; ++i) hash = hashed(hash, (uint32_t)set->rotation[i]);
  for (int i = 0; i < 3; ++i) hash = hashed(hash, (uint16_t)set->velocity[i]);
  hash = hashed(hash, set->sigma_position);
  return hashed(hash, set->age);
}

void follow_log(const uint8_t* log, void (*put)(const char* text)) {
  static const char* const actions[] = {"follow", "ramp", "stop"};
  static const char* const verdicts[] = {
      "ignored",  "partial", "accepted", "wrong_format", "wrong_check", "incomplete",
      "repeated", "jumped",  "no_pose",  "too_old",      "implausible", "node_stopped"};
  const glint_settings settings = {.base = (uint32_t)number_at(log, 4),
                                   .fd = log[4] != 0,
                                   .cycle_us = (uint32_t)number_at(log + 8, 4),
                                   .speed_max = (uint32_t)number_at(log + 12, 4),
                                   .age_max = 1000,
                                   .measured_max = 100000,
                                   .heartbeat = 0x720};
  glint_controller controller;
  glint_init(&controller, &settings);
  log += 16;
  uint64_t cycle_us = number_at(log, 8);
  uint64_t hash = 14695981039346656037U;
  int last = -1;
  int stopped = 0;
  for (;;) {
    const uint64_t now_us = number_at(log, 8);
    const uint32_t identifier = (uint32_t)number_at(log + 8, 4);
    while (cycle_us < now_us) {
      const glint_action action = glint_cycle(&controller, cycle_us);
      if ((int)action != last) put_line(put, cycle_us, actions[action]);
      last = (int)action;
      stopped = action == GLINT_STOP ? stopped + 1 : 0;
      if (stopped >= ENABLE_CYCLES) glint_enable(&controller, cycle_us);
      cycle_us += settings.cycle_us;
    }
    if (identifier == END) break;
    const glint_frame frame = {identifier, log[12] != 0, log[13], log + 16};
    if (glint_receive(&controller, &frame, now_us) == GLINT_ACCEPTED)
      hash = hash_of(hash, &controller.accepted);
    log += 16 + (log[13] + 7) / 8 * 8;
  }
  for (int i = 0; i < GLINT_VERDICTS; ++i) put_line(put, controller.count[i], verdicts[i]);
  put_line(put, hash, "hash of the accepted sets");
}
