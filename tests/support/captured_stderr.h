/** What is written to stderr, for tests of messages. */
#ifndef TESTS_SUPPORT_CAPTURED_STDERR_H
#define TESTS_SUPPORT_CAPTURED_STDERR_H

/** From here on stderr goes to a file. */
void captured_stderr_begin(void);

/** Gives stderr back. Returns what was written, at most 64 KiB, which stays until the next call. */
const char *captured_stderr_end(void);

#endif /* TESTS_SUPPORT_CAPTURED_STDERR_H */
