#include "follow_log.h"

#define EVENT 0xFFFFFF00U /* identifier of an event, in its low byte its kind */

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

void follow_begin(follower* f, const glint_settings* settings, uint64_t first_cycle_us,
                  uint32_t enable_cycles, void (*put)(const char* text)) {
  glint_init(&f->controller, settings);
  f->put = put;
  f->next_cycle_us = first_cycle_us;
  f->hash = 14695981039346656037U;
  f->enable_cycles = enable_cycles;
  f->stopped_cycles = 0;
  f->action = -1;
}

static void run_cycles(follower* f, uint64_t now_us) {
  static const char* const actions[] = {"follow", "ramp", "stop"};
  while (f->next_cycle_us < now_us) {
    const glint_action action = glint_cycle(&f->controller, f->next_cycle_us);
    if ((int)action != f->action) put_line(f->put, f->next_cycle_us, actions[action]);
    f->action = (int)action;
    f->stopped_cycles = action == GLINT_STOP ? f->stopped_cycles + 1 : 0;
    if (f->enable_cycles > 0 && f->stopped_cycles >= f->enable_cycles)
      glint_enable(&f->controller, f->next_cycle_us);
    f->next_cycle_us += f->controller.settings.cycle_us;
  }
}

void follow_frame(follower* f, const glint_frame* frame, uint64_t now_us) {
  run_cycles(f, now_us);
  if (glint_receive(&f->controller, frame, now_us) == GLINT_ACCEPTED)
    f->hash = hash_of(f->hash, &f->controller.accepted);
}

static void put_result(const follower* f) {
  static const char* const verdicts[] = {
      "ignored",  "partial", "accepted", "wrong_format", "wrong_check", "incomplete",
      "repeated", "jumped",  "no_pose",  "too_old",      "implausible", "node_stopped"};
  for (int i = 0; i < GLINT_VERDICTS; ++i) put_line(f->put, f->controller.count[i], verdicts[i]);
  put_line(f->put, f->hash, "hash of the accepted sets");
}

void follow_at(follower* f, follow_event event, uint64_t now_us) {
  run_cycles(f, now_us);
  if (event == FOLLOW_END) put_result(f);
  if (event == FOLLOW_ENABLE)
    put_line(f->put, now_us, glint_enable(&f->controller, now_us) ? "enabled" : "not enabled");
  if (event == FOLLOW_RESTART) {
    const glint_settings settings = f->controller.settings;
    put_result(f);
    put_line(f->put, now_us, "restarted");
    glint_init(&f->controller, &settings);
  }
}

void follow_log(const uint8_t* log, void (*put)(const char* text)) {
  const glint_settings settings = {.base = (uint32_t)number_at(log, 4),
                                   .fd = log[4] != 0,
                                   .cycle_us = (uint32_t)number_at(log + 8, 4),
                                   .speed_max = (uint32_t)number_at(log + 12, 4),
                                   .age_max = 1000,
                                   .measured_max = 100000,
                                   .heartbeat = 0x720};
  follower f;
  follow_begin(&f, &settings, number_at(log + 16, 8), log[5], put);
  uint32_t identifier;
  log += 24;
  do {
    const uint64_t now_us = number_at(log, 8);
    identifier = (uint32_t)number_at(log + 8, 4);
    const glint_frame frame = {identifier, log[12] != 0, log[13], log + 16};
    if (identifier >= EVENT)
      follow_at(&f, (follow_event)(identifier - EVENT), now_us);
    else
      follow_frame(&f, &frame, now_us);
    log += 16 + (log[13] + 7) / 8 * 8;
  } while (identifier != EVENT + FOLLOW_END);
}
