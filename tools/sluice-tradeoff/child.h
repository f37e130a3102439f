/** A child process whose output goes to files. */
#ifndef SLUICE_TRADEOFF_CHILD_H
#define SLUICE_TRADEOFF_CHILD_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

struct child_info {
    char *const *arguments;  ///< the program's path first, NULL last
    const char *out, *error; ///< files for standard output and standard error, replaced
    double limit;            ///< seconds; 0: none
    char *environment;       ///< "NAME=value" that is added, or NULL
};

struct child {
    pid_t pid;              ///< 0: none
    struct child_info info; ///< borrowed until the child has ended
    double started;         ///< clock_seconds()
    const char *killed;     ///< reason why the child was killed, or NULL
};

enum child_state { CHILD_RUNS, CHILD_DONE, CHILD_FAILED };

/**
 * Starts a child in its own process group, which dies with this process. Returns false with errno
 * if fork fails or the files cannot be written. A program that does not exist is a child that
 * fails.
 */
bool child_begin(const struct child_info *info, struct child *child);
/** Starts a child in its own session, where it outlives this process. Nothing watches or ends it:
 * `limit` is ignored. Returns false with errno if fork fails or the files cannot be written. */
bool child_begin_detached(const struct child_info *info);
/** Checks the time limit and the size of the output. */
enum child_state child_poll(struct child *child, int *status);
/** Kills the child and its descendants, and waits for them. */
void child_kill(struct child *child);
/** Waits until the child has ended or the program is interrupted. */
enum child_state child_wait(struct child *child, int *status);
/** Returns why the child failed: "exit status 2: the last line of standard error". Free the
 * result. */
char *child_reason(const struct child *child, int status);

/** Begins to note interruptions (SIGINT, SIGTERM, SIGHUP). */
void child_watch_interruptions(void);
bool child_is_interrupted(void);

#endif /* SLUICE_TRADEOFF_CHILD_H */
