/** A sweep from its command line to its results, and what a results folder remembers of it. */
#ifndef SLUICE_TRADEOFF_SESSION_H
#define SLUICE_TRADEOFF_SESSION_H

#include "runs.h"

/** Zeroed is empty. */
struct session {
    struct options options;
    struct program program;
    struct sweep sweep;
    struct runs runs;
};

/**
 * Finds the program, plans, and looks which runs are there; `own_path` is this tool's executable.
 * With `recall` nothing is started or written: the program is as the results folder remembers it.
 * False if that cannot be done, said on stderr.
 */
bool session_open(struct session *session, const char *own_path, bool recall);
void session_close(struct session *session);

/** Keeps the words of a command line in a results folder. False and a line on stderr if not. */
bool session_remember(const char *results, int argc, char *const *argv);
/** Reads them back. False and a line on stderr if there are none. */
bool session_recall(const char *results, struct text_list *arguments);

#endif /* SLUICE_TRADEOFF_SESSION_H */
