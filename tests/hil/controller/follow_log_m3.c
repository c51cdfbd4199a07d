/* The same on QEMU's mps2-an385 (Cortex-M3): no library, the log at the start of the PSRAM, text to
 * the first UART, then power off by semihosting. */
#include "follow_log.h"

#define LOG ((const uint8_t*)0x21000000U)
#define UART(offset) (*(volatile uint32_t*)(0x40004000U + (offset)))

int main(void);
static void reset(void) { main(); }

extern uint32_t stack_top;
__attribute__((section(".vectors"), used)) static const void* const vectors[] = {
    &stack_top, (const void*)reset};

static void put(const char* text) {
  for (; *text != 0; ++text) {
    while ((UART(4) & 1U) != 0) {
    }
    UART(0) = (uint32_t)(unsigned char)*text;
  }
}

static void power_off(void) {
  register uint32_t call __asm__("r0") = 0x18;
  register uint32_t reason __asm__("r1") = 0x20026; /* ADP_Stopped_ApplicationExit */
  __asm__ volatile("bkpt 0xAB" : : "r"(call), "r"(reason) : "memory");
}

int main(void) {
  UART(0x10) = 16; /* baud divider */
  UART(8) = 1;     /* transmit */
  follow_log(LOG, put);
  power_off();
  for (;;) {
  }
}
