/**
 * Protection from SIGPIPE. On POSIX, a write to a connection closed by the other end raises
 * SIGPIPE, which ends the process. Other systems have no such signal.
 */
#ifndef SLC_PLATFORM_PIPE_SIGNAL_H
#define SLC_PLATFORM_PIPE_SIGNAL_H

#include <stdbool.h>

struct slc_pipe_signal {
    bool is_blocked, was_pending; ///< is_blocked: by slc_pipe_signal_block, not before
};

/** Blocks SIGPIPE on this thread until slc_pipe_signal_restore. Keeps the process's handlers. */
void slc_pipe_signal_block(struct slc_pipe_signal *signal);
/** Drops signals since slc_pipe_signal_block. Call it on the same thread. */
void slc_pipe_signal_restore(const struct slc_pipe_signal *signal);

#endif /* SLC_PLATFORM_PIPE_SIGNAL_H */
