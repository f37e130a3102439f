/** Messages on stderr, kept for the window, with advice. */
#ifndef SLUICE_VIEW_MESSAGES_H
#define SLUICE_VIEW_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MESSAGES_KEPT 256u

/** Begins to keep the lines of text_say. There is one list per program. */
void messages_begin(void);
/** Stops keeping lines. No other thread may call text_say during the call. */
void messages_end(void);
/** Number of lines so far. Thread safety: any thread. */
uint32_t messages_count(void);
/** Copies line `number`, counted from 0, without the name of the program. False if the line is no
 *  longer kept: only the last MESSAGES_KEPT are. Thread safety: any thread. */
bool messages_get(uint32_t number, char *text, size_t size);
/** Returns advice about a line; NULL: none. */
const char *messages_advice(const char *text);

#endif /* SLUICE_VIEW_MESSAGES_H */
