#define _POSIX_C_SOURCE 200809L

#include "platform/pipe_signal.h"

#include <signal.h>
#include <stddef.h>

static bool is_pending(void)
{
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    return sigismember(&pending, SIGPIPE) == 1;
}

void slc_pipe_signal_block(struct slc_pipe_signal *signal)
{
    sigset_t pipe, before;
    sigemptyset(&pipe);
    sigemptyset(&before);
    sigaddset(&pipe, SIGPIPE);
    signal->was_pending = is_pending();
    signal->is_blocked =
        pthread_sigmask(SIG_BLOCK, &pipe, &before) == 0 && sigismember(&before, SIGPIPE) == 0;
}

void slc_pipe_signal_restore(const struct slc_pipe_signal *signal)
{
    sigset_t pipe;
    int number;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    /* SIGPIPE of a write is pending on the writing thread, so on this thread. */
    if (!signal->was_pending && is_pending())
        sigwait(&pipe, &number);
    if (signal->is_blocked)
        pthread_sigmask(SIG_UNBLOCK, &pipe, NULL);
}
