/** Progress on stderr: a line that is redrawn on a terminal, else a new line from time to time. */
#ifndef TOOLS_COMMON_PROGRESS_H
#define TOOLS_COMMON_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    const char *what; ///< borrowed
    const char *unit; ///< borrowed; such as "texels"
    uint64_t total;
    double start, last_shown;
    bool terminal;
};

void progress_begin(struct progress *progress, const char *what, const char *unit, uint64_t total);
/** Shows the progress, the rate and the time left. May be called often. */
void progress_update(struct progress *progress, uint64_t done);
/** Shows the total time. */
void progress_end(struct progress *progress);

#endif /* TOOLS_COMMON_PROGRESS_H */
