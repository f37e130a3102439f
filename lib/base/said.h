/**
 * What a log was told already. A file with 182 damaged tiles, each read four times, is a few lines:
 * each fault is said once, at most SLC_SAID_MAX of them; statistics count the rest.
 */
#ifndef SLC_BASE_SAID_H
#define SLC_BASE_SAID_H

#include <sluice/base.h>

#define SLC_SAID_MAX 16u

/** Zeroed: nothing was said. */
struct slc_said {
    _Atomic uint64_t keys[SLC_SAID_MAX]; ///< 0: none; the first ones are filled first
};

enum slc_say {
    SLC_SAY_NOTHING, ///< it was said, or too much was
    SLC_SAY_IT,
    SLC_SAY_IT_LAST ///< and that it is the last
};

/** A key for what a text says. */
uint64_t slc_said_key(const char *text);

/** Notes that it is said now. `said` NULL: SAY_IT. Any thread. */
enum slc_say slc_said_note(struct slc_said *said, uint64_t key);

/** Logs "PATH: MESSAGE" as an error, unless it was said or too much was. Any thread. */
void slc_said_log(struct slc_said *said, const SluiceLogCallback *log, const char *path,
                  uint64_t key, const char *message);

#endif /* SLC_BASE_SAID_H */
