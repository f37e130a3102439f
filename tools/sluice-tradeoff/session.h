/** Session: a sweep from its command line to its results, and its memory in the results folder. */
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
 * Finds the program, plans the runs, and finds the existing ones. `own_path`: this tool's
 * executable. `recall`: starts and writes nothing, and takes the program from the results folder.
 * Reports errors on stderr.
 */
bool session_open(struct session *session, const char *own_path, bool recall);
void session_close(struct session *session);

/** Writes the words of a command line to a results folder. Reports errors on stderr. */
bool session_remember(const char *results, int argc, char *const *argv);
/** Reads the words of session_remember. Reports errors on stderr. */
bool session_recall(const char *results, struct text_list *arguments);

#endif /* SLUICE_TRADEOFF_SESSION_H */
