/* A QEMU TCG plug-in: how many guest instructions run between two markers, call by call.
 *
 *   qemu-aarch64 -plugin ./glint_count_instructions.so,out=FILE program
 *
 * Every translated block adds its length to one counter when it begins, inline, without a call: an
 * emulated program runs at nearly its usual emulated speed. The markers are functions of one block,
 * glint_measure_begin and glint_measure_end, found by their symbols in the static program; each
 * pair leaves one unsigned 64-bit number in FILE. For one thread.
 *
 * Source: QEMU's plug-in interface, version 1 (QEMU 4.2 to 7.2), docs/devel/tcg-plugins. Debian
 * ships no header, so what is used of it is declared here.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORTED __attribute__((visibility("default")))

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef struct qemu_info_t qemu_info_t;
enum qemu_plugin_op { QEMU_PLUGIN_INLINE_ADD_U64 };
enum qemu_plugin_cb_flags { QEMU_PLUGIN_CB_NO_REGS };

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t,
                                                            struct qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb* block, enum qemu_plugin_op op,
                                              void* target, uint64_t amount);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn* instruction,
                                            void (*callback)(unsigned, void*),
                                            enum qemu_plugin_cb_flags flags, void* data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*),
                                    void* data);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* block);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb* block, size_t index);
const char* qemu_plugin_insn_symbol(const struct qemu_plugin_insn* instruction);

EXPORTED int qemu_plugin_version = 1;

static uint64_t executed;
static uint64_t executed_at_begin;
static FILE* out;

static void begin(unsigned cpu, void* data) {
  (void)cpu;
  (void)data;
  executed_at_begin = executed;
}

static void end(unsigned cpu, void* data) {
  const uint64_t count = executed - executed_at_begin;
  (void)cpu;
  (void)data;
  if (fwrite(&count, sizeof count, 1, out) != 1) {
    fprintf(stderr, "count_instructions: the counts cannot be written\n");
    exit(1);
  }
}

static void translate(qemu_plugin_id_t id, struct qemu_plugin_tb* block) {
  struct qemu_plugin_insn* first = qemu_plugin_tb_get_insn(block, 0);
  const char* symbol = qemu_plugin_insn_symbol(first);
  (void)id;
  qemu_plugin_register_vcpu_tb_exec_inline(block, QEMU_PLUGIN_INLINE_ADD_U64, &executed,
                                           qemu_plugin_tb_n_insns(block));
  if (symbol == NULL) return;
  if (strcmp(symbol, "glint_measure_begin") == 0) {
    qemu_plugin_register_vcpu_insn_exec_cb(first, begin, QEMU_PLUGIN_CB_NO_REGS, NULL);
  } else if (strcmp(symbol, "glint_measure_end") == 0) {
    qemu_plugin_register_vcpu_insn_exec_cb(first, end, QEMU_PLUGIN_CB_NO_REGS, NULL);
  }
}

static void finish(qemu_plugin_id_t id, void* data) {
  (void)id;
  (void)data;
  fclose(out);
}

EXPORTED int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc,
                                 char** argv) {
  const char* file = NULL;
  (void)info;
  for (int i = 0; i < argc; ++i) {
    if (strncmp(argv[i], "out=", 4) == 0) file = argv[i] + 4;
  }
  out = file == NULL ? NULL : fopen(file, "wb");
  if (out == NULL) {
    fprintf(stderr, "count_instructions: expected out=FILE that can be written\n");
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_atexit_cb(id, finish, NULL);
  return 0;
}
