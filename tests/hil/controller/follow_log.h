/* A controller that receives a CAN log: its decisions as text, the same on every processor. */
#ifndef GLINT_FOLLOW_LOG_H
#define GLINT_FOLLOW_LOG_H

#include <stdint.h>

/* `log`: settings, then frames, as pack_log.py writes them. `put` receives each line's parts. */
void follow_log(const uint8_t* log, void (*put)(const char* text));

#endif
