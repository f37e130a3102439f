/** A program that runs beside this one, whose output goes to files. */
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
    struct child_info info; ///< borrowed until it has ended
    double started;         ///< clock_seconds()
    const char *killed;     ///< why it was, or NULL
};

enum child_state { CHILD_RUNS, CHILD_DONE, CHILD_FAILED };

/**
 * Starts it in a process group of its own that dies with this process. False with errno if it
 * cannot be forked or the files cannot be written; a program that is not there is a failed child.
 */
bool child_begin(const struct child_info *info, struct child *child);
/** Starts it in a session of its own, where it outlives this process. Nothing watches or ends it:
 *  `limit` is ignored. False with errno if it cannot be forked or the files cannot be written. */
bool child_begin_detached(const struct child_info *info);
/** Looks after it: time limit and the size of its output. */
enum child_state child_poll(struct child *child, int *status);
/** Ends it and what it started, and waits for that. */
void child_kill(struct child *child);
/** Until it has ended, but not after an interruption. */
enum child_state child_wait(struct child *child, int *status);
/** Why it failed: "exit status 2: the last line of standard error"; to be freed. */
char *child_reason(const struct child *child, int status);

/** Interruptions (SIGINT, SIGTERM, SIGHUP) are taken note of from now on. */
void child_watch_interruptions(void);
bool child_is_interrupted(void);

#endif /* SLUICE_TRADEOFF_CHILD_H */
