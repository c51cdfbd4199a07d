/* Checks and decodes the frames of a pose: E2E profile 1 (classic) and 5 (FD) of AUTOSAR. */
#include "glint_can_layout.h"
#include "glint_controller.h"

#define GLINT_ONE (1 << 30)

/* Steps of the layout in the units of glint_set; each is a whole number. */
#define GLINT_WHOLE(x) ((int32_t)((x) + 0.5))
#define GLINT_POSITION_UM GLINT_WHOLE(1000 * GLINT_POSITION_X_STEP)
#define GLINT_AGE_UNITS GLINT_WHOLE(10 * GLINT_QUALITY_AGE_STEP)
#define GLINT_COMPONENT_2_46 ((int64_t)(GLINT_ORIENTATION_COMPONENT0_STEP * 70368744177664.0 + 0.5))

static uint64_t unsigned_signal(const uint8_t* data, int first_bit, int width) {
  uint64_t value = 0;
  for (int i = 0; i < width; ++i) {
    const int bit = first_bit + i;
    value |= (uint64_t)(data[bit / 8] >> (bit % 8) & 1U) << i;
  }
  return value;
}

static int32_t signed_signal(const uint8_t* data, int first_bit, int width) {
  const int64_t value = (int64_t)unsigned_signal(data, first_bit, width);
  const int64_t half = (int64_t)1 << (width - 1);
  return (int32_t)(value >= half ? value - 2 * half : value);
}

/* CRC-8 SAE J1850, continued from `crc`, without inversion. */
static uint8_t crc8(uint8_t crc, uint8_t byte) {
  crc ^= byte;
  for (int i = 0; i < 8; ++i) crc = (uint8_t)((unsigned)crc << 1 ^ (crc & 0x80U ? 0x1DU : 0U));
  return crc;
}

/* CRC-16 CCITT-FALSE, likewise. */
static uint16_t crc16(uint16_t crc, uint8_t byte) {
  crc = (uint16_t)(crc ^ (uint16_t)byte << 8);
  for (int i = 0; i < 8; ++i) crc = (uint16_t)((unsigned)crc << 1 ^ (crc & 0x8000U ? 0x1021U : 0U));
  return crc;
}

static bool check_classic(const glint_frame* frame) {
  uint8_t crc = crc8(0, (uint8_t)(frame->identifier & 0xFFU));
  crc = crc8(crc, (uint8_t)(frame->identifier >> 8));
  for (int i = 1; i < frame->length; ++i) crc = crc8(crc, frame->data[i]);
  return crc == frame->data[0] && (frame->data[1] & 0xFU) <= 14;
}

static bool check_fd(const glint_frame* frame) {
  uint16_t crc = 0xFFFF;
  for (int i = 2; i < frame->length; ++i) crc = crc16(crc, frame->data[i]);
  crc = crc16(crc, (uint8_t)(frame->identifier & 0xFFU));
  crc = crc16(crc, (uint8_t)(frame->identifier >> 8));
  return crc == (frame->data[0] | frame->data[1] << 8);
}

static int32_t root(uint64_t square) {
  uint64_t result = 0;
  for (uint64_t bit = (uint64_t)1 << 30; bit != 0; bit >>= 1) {
    const uint64_t larger = result | bit;
    if (larger * larger <= square) result = larger;
  }
  return (int32_t)result;
}

/* The omitted component is positive and follows from unit length. */
static void decode_rotation(const uint8_t* data, int32_t rotation[4]) {
  const int32_t part[3] = {signed_signal(data, GLINT_ORIENTATION_COMPONENT0),
                           signed_signal(data, GLINT_ORIENTATION_COMPONENT1),
                           signed_signal(data, GLINT_ORIENTATION_COMPONENT2)};
  const int left_out = (int)unsigned_signal(data, GLINT_ORIENTATION_LEFT_OUT);
  int64_t rest = (int64_t)GLINT_ONE * GLINT_ONE;
  int next = 0;
  for (int i = 0; i < 4; ++i) {
    if (i == left_out) continue;
    const int64_t scaled = part[next++] * GLINT_COMPONENT_2_46;
    rotation[i] = (int32_t)((scaled + (scaled < 0 ? -32768 : 32768)) / 65536);
    rest -= (int64_t)rotation[i] * rotation[i];
  }
  rotation[left_out] = rest > 0 ? root((uint64_t)rest) : 0;
}

/* All ones of `width` bits keep their meaning: "this or more, or unknown". */
static uint16_t saturating(const uint8_t* data, int first_bit, int width) {
  return (uint16_t)unsigned_signal(data, first_bit, width);
}

static uint16_t age_of(uint16_t raw, uint16_t all_ones, int32_t units) {
  return raw == all_ones ? 0xFFFF : (uint16_t)(raw * units);
}

static bool has_pose(uint64_t state) {
  return state == GLINT_STATE_MEASURED || state == GLINT_STATE_PREDICTED;
}

static void decode_classic(const uint8_t* data, uint32_t message, glint_set* set) {
  set->counter = (uint8_t)unsigned_signal(data, GLINT_POSITION_COUNTER);
  switch (message) {
    case GLINT_POSITION_OFFSET:
      set->has_position = unsigned_signal(data, GLINT_POSITION_VALID) == GLINT_VALID_VALID;
      set->position_um[0] = signed_signal(data, GLINT_POSITION_X) * GLINT_POSITION_UM;
      set->position_um[1] = signed_signal(data, GLINT_POSITION_Y) * GLINT_POSITION_UM;
      set->position_um[2] = signed_signal(data, GLINT_POSITION_Z) * GLINT_POSITION_UM;
      break;
    case GLINT_ORIENTATION_OFFSET:
      set->has_rotation = has_pose(unsigned_signal(data, GLINT_ORIENTATION_STATE));
      decode_rotation(data, set->rotation);
      break;
    case GLINT_VELOCITY_OFFSET:
      set->velocity[0] = (int16_t)signed_signal(data, GLINT_VELOCITY_X);
      set->velocity[1] = (int16_t)signed_signal(data, GLINT_VELOCITY_Y);
      set->velocity[2] = (int16_t)signed_signal(data, GLINT_VELOCITY_Z);
      break;
    case GLINT_ANGULAR_VELOCITY_OFFSET:
      set->angular_velocity[0] = (int16_t)signed_signal(data, GLINT_ANGULAR_VELOCITY_X);
      set->angular_velocity[1] = (int16_t)signed_signal(data, GLINT_ANGULAR_VELOCITY_Y);
      set->angular_velocity[2] = (int16_t)signed_signal(data, GLINT_ANGULAR_VELOCITY_Z);
      break;
    default: /* quality */
      set->state = (uint8_t)unsigned_signal(data, GLINT_QUALITY_STATE);
      set->registration = (uint8_t)unsigned_signal(data, GLINT_QUALITY_REGISTRATION);
      set->markers = (uint8_t)unsigned_signal(data, GLINT_QUALITY_MARKERS);
      set->sigma_position = saturating(data, GLINT_QUALITY_SIGMA_POSITION);
      set->sigma_orientation = saturating(data, GLINT_QUALITY_SIGMA_ORIENTATION);
      set->age = age_of(saturating(data, GLINT_QUALITY_AGE), 0x7FF, GLINT_AGE_UNITS);
      set->registration_rms = saturating(data, GLINT_QUALITY_REGISTRATION_RMS);
      set->buttons = (uint8_t)unsigned_signal(data, GLINT_QUALITY_BUTTONS);
      break;
  }
}

static void decode_fd(const uint8_t* data, glint_set* set) {
  set->counter = (uint8_t)unsigned_signal(data, GLINT_POSE_FD_COUNTER);
  set->state = (uint8_t)unsigned_signal(data, GLINT_POSE_FD_STATE);
  set->has_position = has_pose(set->state);
  set->has_rotation = set->has_position;
  set->registration = (uint8_t)unsigned_signal(data, GLINT_POSE_FD_REGISTRATION);
  set->buttons = (uint8_t)unsigned_signal(data, GLINT_POSE_FD_BUTTONS);
  set->position_um[0] = signed_signal(data, GLINT_POSE_FD_X);
  set->position_um[1] = signed_signal(data, GLINT_POSE_FD_Y);
  set->position_um[2] = signed_signal(data, GLINT_POSE_FD_Z);
  set->rotation[0] = signed_signal(data, GLINT_POSE_FD_ROTATION_X);
  set->rotation[1] = signed_signal(data, GLINT_POSE_FD_ROTATION_Y);
  set->rotation[2] = signed_signal(data, GLINT_POSE_FD_ROTATION_Z);
  set->rotation[3] = signed_signal(data, GLINT_POSE_FD_ROTATION_W);
  set->velocity[0] = (int16_t)signed_signal(data, GLINT_POSE_FD_VELOCITY_X);
  set->velocity[1] = (int16_t)signed_signal(data, GLINT_POSE_FD_VELOCITY_Y);
  set->velocity[2] = (int16_t)signed_signal(data, GLINT_POSE_FD_VELOCITY_Z);
  set->angular_velocity[0] = (int16_t)signed_signal(data, GLINT_POSE_FD_ANGULAR_VELOCITY_X);
  set->angular_velocity[1] = (int16_t)signed_signal(data, GLINT_POSE_FD_ANGULAR_VELOCITY_Y);
  set->angular_velocity[2] = (int16_t)signed_signal(data, GLINT_POSE_FD_ANGULAR_VELOCITY_Z);
  set->sigma_position = saturating(data, GLINT_POSE_FD_SIGMA_POSITION);
  set->sigma_orientation = saturating(data, GLINT_POSE_FD_SIGMA_ORIENTATION);
  set->age = saturating(data, GLINT_POSE_FD_AGE);
  set->markers = (uint8_t)unsigned_signal(data, GLINT_POSE_FD_MARKERS);
  set->registration_rms = saturating(data, GLINT_POSE_FD_REGISTRATION_RMS);
}

glint_verdict glint_decode(const glint_frame* frame, uint32_t message, glint_set* set) {
  const bool fd = message == GLINT_POSE_FD_OFFSET;
  if (!fd && message > GLINT_QUALITY_OFFSET) return GLINT_IGNORED;
  if (frame->fd != fd || frame->length != (fd ? GLINT_POSE_FD_BYTES : GLINT_POSITION_BYTES))
    return GLINT_WRONG_FORMAT;
  if (!(fd ? check_fd(frame) : check_classic(frame))) return GLINT_WRONG_CHECK;
  if (fd)
    decode_fd(frame->data, set);
  else
    decode_classic(frame->data, message, set);
  return GLINT_PARTIAL;
}
