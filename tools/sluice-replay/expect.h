/** Compares a dump with a file, line by line. */
#ifndef TOOLS_SLUICE_REPLAY_EXPECT_H
#define TOOLS_SLUICE_REPLAY_EXPECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct expectation {
    const char *path;
    char *text;    ///< owned
    size_t size;   ///< bytes of the text
    char *next;    ///< first character of the next line
    size_t number; ///< number of that line, from 1
    bool hash_only;
    bool differs;
};

/** Reads at most `memory` bytes. Reports errors on stderr. */
bool expectation_open(struct expectation *expectation, const char *path, uint64_t memory);

/** Compares the next line. Reports the first difference on stderr. */
void expectation_line(struct expectation *expectation, const char *line);

/** Returns true if all lines were as expected and none is missing. */
bool expectation_close(struct expectation *expectation);

#endif /* TOOLS_SLUICE_REPLAY_EXPECT_H */
