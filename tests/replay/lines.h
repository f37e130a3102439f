/** A text dump, kept. */
#ifndef TESTS_REPLAY_LINES_H
#define TESTS_REPLAY_LINES_H

#include <stddef.h>

struct lines {
    char *text; ///< owned; each line ends with a newline
    size_t size, capacity;
};

/** A SluiceReplayInfo's pfnLine; `user` is a zeroed struct lines at first. */
void lines_take(void *user, const char *line);
void lines_free(struct lines *lines);

#endif /* TESTS_REPLAY_LINES_H */
