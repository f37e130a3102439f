/**
 * Writes to connections that the other end has closed raise SIGPIPE, which ends the process. Other
 * systems than POSIX have no such signal.
 */
#ifndef SLC_PLATFORM_PIPE_SIGNAL_H
#define SLC_PLATFORM_PIPE_SIGNAL_H

#include <stdbool.h>

struct slc_pipe_signal {
    bool is_blocked, was_pending; ///< is_blocked: here, and not before
};

/** Keeps SIGPIPE from this thread until slc_pipe_signal_restore. Handlers of the process stay. */
void slc_pipe_signal_block(struct slc_pipe_signal *signal);
/** Drops the signals that came meanwhile. The same thread. */
void slc_pipe_signal_restore(const struct slc_pipe_signal *signal);

#endif /* SLC_PLATFORM_PIPE_SIGNAL_H */
