/**
 * Messages of the library on stderr: each once, and not too many about one file. A damaged file has
 * hundreds of tiles, each of which is read again and again.
 */
#ifndef TOOLS_COMMON_LOG_H
#define TOOLS_COMMON_LOG_H

#include <sluice/base.h>

#define LOG_LINES_PER_FILE 32u

/**
 * pfnLog of a SluiceLogCallback. `user_data`: prefix of each line, which must stay valid, or NULL.
 * Leaves out infos and repeated messages. Prints the first LOG_LINES_PER_FILE messages about a file
 * and counts the others. The words before ": " name the file. Writes control characters like
 * text_write. Any thread.
 */
void log_say(void *user_data, SluiceLogSeverity severity, const char *message);

/** Prints for each file how many messages were only counted, and resets the counts. */
void log_finish(void);

#endif /* TOOLS_COMMON_LOG_H */
