/** Compares a dump, line by line as it comes, with a file. */
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
    size_t number; ///< of that line, from 1 on
    bool hash_only;
    bool differs;
};

/** Reads at most `memory` bytes. On failure says why on standard error. */
bool expectation_open(struct expectation *expectation, const char *path, uint64_t memory);

/** Says on standard error which line differs, if it is the first. */
void expectation_line(struct expectation *expectation, const char *line);

/** True if every line was as expected and none is missing. */
bool expectation_close(struct expectation *expectation);

#endif /* TOOLS_SLUICE_REPLAY_EXPECT_H */
