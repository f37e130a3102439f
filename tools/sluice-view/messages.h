/** Lines that the program says on stderr, kept for the window, and what to do about them. */
#ifndef SLUICE_VIEW_MESSAGES_H
#define SLUICE_VIEW_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MESSAGES_KEPT 256u

/** Keeps the lines of text_say from now on. There is one list per program. */
void messages_begin(void);
/** Keeps no more lines. No other thread may say anything during the call. */
void messages_end(void);
/** How many lines were said. Thread safety: any thread, as is messages_get. */
uint32_t messages_count(void);
/** Copies a line, the first is 0, without the name of the program. False if it is not kept: the
 *  last MESSAGES_KEPT are. */
bool messages_get(uint32_t number, char *text, size_t size);
/** What to do about a line; NULL if nothing is known. */
const char *messages_advice(const char *text);

#endif /* SLUICE_VIEW_MESSAGES_H */
