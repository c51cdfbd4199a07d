/* Frames for Glint through shared memory ([source] kind = "shm"): C99, Linux, one thread.
 *
 *   struct glint_frames f;
 *   if (glint_frames_connect(&f, "/run/glint.sock", 512, 512, 16) != 0) puts(f.error);
 *   while (f.socket_fd >= 0) {
 *     uint16_t* depth = glint_frames_begin(&f);   rows without padding, the cell's raw unit
 *     if (depth == NULL) continue;                all slots wait for Glint: drop the frame
 *     ...fill depth, then reflectivity of 8 or 16 bits at (char*)depth + f.depth_bytes...
 *     glint_frames_send(&f, stamp_ns, NULL);      mid-exposure by any clock of the device
 *   }
 * In place of NULL: T_world_camera as x, y, z in metres and a quaternion x, y, z, w. */
#ifndef GLINT_FRAMES_H
#define GLINT_FRAMES_H
#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* for memfd_create: before any other header */
#endif
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { GLINT_FRAMES_SLOTS = 4, GLINT_FRAMES_HEAD = 64 }; /* bytes before the depth: 8 of them count
                                                            writes, odd while one goes on */
struct glint_frames_hello { /* producer to Glint, with the memory's descriptor */
  char magic[8];            /* GLINTFR1 */
  uint32_t width, height, reflectivity_bits, slots; uint64_t slot_bytes;
};
struct glint_frames_reply { char refused[256]; }; /* Glint to producer; empty: accepted */
struct glint_frames_frame { /* producer to Glint; each is answered by its slot's number, 32 bits */
  uint32_t slot, has_pose;
  uint64_t sequence; int64_t stamp_ns;
  double pose[7];
};
struct glint_frames {
  int socket_fd; /* -1: error states why */
  char* memory; size_t depth_bytes, slot_bytes;
  uint64_t sequence; unsigned busy, slot;
  char error[256];
};

static inline int glint_frames_fail(struct glint_frames* f, const char* what) {
  if (f->socket_fd >= 0) close(f->socket_fd);
  f->socket_fd = -1, snprintf(f->error, sizeof f->error, "%s", what);
  return -1;
}
static inline int glint_frames_connect(struct glint_frames* f, const char* path, uint32_t width,
                                       uint32_t height, uint32_t reflectivity_bits) {
  struct glint_frames_hello hello; struct glint_frames_reply reply; struct sockaddr_un address;
  struct iovec data = {&hello, sizeof hello}; struct msghdr message;
  union { size_t aligned; char bytes[CMSG_SPACE(sizeof(int))]; } control;
  memset(f, 0, sizeof *f), memset(&hello, 0, sizeof hello), memset(&address, 0, sizeof address);
  memset(&control, 0, sizeof control), memset(&message, 0, sizeof message);
  f->depth_bytes = 2u * (size_t)width * height;
  f->slot_bytes = (GLINT_FRAMES_HEAD + f->depth_bytes * (reflectivity_bits > 8 ? 4 : 3) / 2 + 63) / 64 * 64;
  memcpy(hello.magic, "GLINTFR1", 8);
  hello.width = width, hello.height = height, hello.reflectivity_bits = reflectivity_bits;
  hello.slots = GLINT_FRAMES_SLOTS, hello.slot_bytes = f->slot_bytes;
  address.sun_family = AF_UNIX;
  snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
  f->socket_fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (connect(f->socket_fd, (struct sockaddr*)&address, sizeof address) != 0)
    return glint_frames_fail(f, "no Glint listens at this path");
  const size_t bytes = GLINT_FRAMES_SLOTS * f->slot_bytes;
  const int memory = memfd_create("glint_frames", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (ftruncate(memory, (off_t)bytes) != 0 || fcntl(memory, F_ADD_SEALS, F_SEAL_SHRINK) != 0)
    return glint_frames_fail(f, "no shared memory");
  f->memory = (char*)mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
  message.msg_iov = &data, message.msg_iovlen = 1;
  message.msg_control = control.bytes, message.msg_controllen = sizeof control.bytes;
  struct cmsghdr* head = CMSG_FIRSTHDR(&message);
  head->cmsg_len = CMSG_LEN(sizeof memory), head->cmsg_level = SOL_SOCKET, head->cmsg_type = SCM_RIGHTS;
  memcpy(CMSG_DATA(head), &memory, sizeof memory);
  ssize_t got = sendmsg(f->socket_fd, &message, MSG_NOSIGNAL);
  close(memory); /* refused before the hello: sending fails, a reset hides the reply once */
  for (int i = 0; i < 2 && got != (ssize_t)sizeof reply; ++i) got = recv(f->socket_fd, &reply, sizeof reply, 0);
  if (got != (ssize_t)sizeof reply) return glint_frames_fail(f, "Glint does not answer");
  return reply.refused[0] == 0 ? 0 : glint_frames_fail(f, reply.refused);
}
static inline uint16_t* glint_frames_begin(struct glint_frames* f) {
  uint32_t back; ssize_t got;
  while ((got = recv(f->socket_fd, &back, sizeof back, MSG_DONTWAIT)) == (ssize_t)sizeof back)
    f->busy &= ~(1u << back % GLINT_FRAMES_SLOTS);
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) { /* also with no slot to send */
    glint_frames_fail(f, "Glint closed the connection");
    return NULL;
  }
  for (f->slot = 0; f->slot < GLINT_FRAMES_SLOTS && (f->busy >> f->slot & 1u); ++f->slot) {}
  if (f->slot == GLINT_FRAMES_SLOTS) return NULL;
  char* slot = f->memory + f->slot * f->slot_bytes;
  __atomic_add_fetch((uint64_t*)(void*)slot, 1, __ATOMIC_SEQ_CST);
  return (uint16_t*)(void*)(slot + GLINT_FRAMES_HEAD);
}
static inline int glint_frames_send(struct glint_frames* f, int64_t stamp_ns, const double* pose) {
  struct glint_frames_frame frame = {f->slot, pose != NULL, f->sequence++, stamp_ns, {0}};
  if (pose != NULL) memcpy(frame.pose, pose, sizeof frame.pose);
  __atomic_add_fetch((uint64_t*)(void*)(f->memory + f->slot * f->slot_bytes), 1, __ATOMIC_SEQ_CST);
  f->busy |= 1u << f->slot;
  return send(f->socket_fd, &frame, sizeof frame, MSG_NOSIGNAL) == (ssize_t)sizeof frame ? 0 : glint_frames_fail(f, "Glint closed the connection");
}
#endif
