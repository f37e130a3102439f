/** Captures stderr, for tests of messages. */
#ifndef TESTS_SUPPORT_CAPTURED_STDERR_H
#define TESTS_SUPPORT_CAPTURED_STDERR_H

/** Redirects stderr to a file. */
void captured_stderr_begin(void);

/** Restores stderr. Returns at most 64 KiB of captured text, valid until the next call. */
const char *captured_stderr_end(void);

#endif /* TESTS_SUPPORT_CAPTURED_STDERR_H */
