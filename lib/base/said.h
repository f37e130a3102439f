/**
 * Messages that were logged already. Each fault is logged once, at most SLC_SAID_MAX faults;
 * statistics count all. So a file with 182 damaged tiles, each read four times, gives a few lines.
 */
#ifndef SLC_BASE_SAID_H
#define SLC_BASE_SAID_H

#include <sluice/base.h>

#define SLC_SAID_MAX 16u

/** Logged messages. Zeroed: none. */
struct slc_said {
    _Atomic uint64_t keys[SLC_SAID_MAX]; ///< 0: none; the first ones are filled first
};

enum slc_say {
    SLC_SAY_NOTHING, ///< logged before, or too many faults were logged
    SLC_SAY_IT,
    SLC_SAY_IT_LAST ///< log it, and that it is the last one
};

/** Returns a key for a text. */
uint64_t slc_said_key(const char *text);

/** Notes a message, and returns whether to log it. `said` NULL: SAY_IT. Any thread. */
enum slc_say slc_said_note(struct slc_said *said, uint64_t key);

/** Logs "PATH: MESSAGE" as an error, unless it was logged or too many were. Any thread. */
void slc_said_log(struct slc_said *said, const SluiceLogCallback *log, const char *path,
                  uint64_t key, const char *message);

#endif /* SLC_BASE_SAID_H */
