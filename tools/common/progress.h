/** A progress bar on stderr: a line that is redrawn on a terminal, a line now and then elsewhere.
 */
#ifndef TOOLS_COMMON_PROGRESS_H
#define TOOLS_COMMON_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    const char *what; ///< borrowed
    const char *unit; ///< borrowed; "texels" and the like
    uint64_t total;
    double start, last_shown;
    bool terminal;
};

void progress_begin(struct progress *progress, const char *what, const char *unit, uint64_t total);
/** Shows how far it is, the rate and the time left; may be called often. */
void progress_update(struct progress *progress, uint64_t done);
/** Shows the whole time it took. */
void progress_end(struct progress *progress);

#endif /* TOOLS_COMMON_PROGRESS_H */
