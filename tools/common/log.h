/**
 * Messages of the library on stderr: each once, and not too many about one file. A damaged file has
 * hundreds of tiles, each of which is read again and again.
 */
#ifndef TOOLS_COMMON_LOG_H
#define TOOLS_COMMON_LOG_H

#include <sluice/base.h>

#define LOG_LINES_PER_FILE 32u

/**
 * A SluiceLogCallback's pfnLog. `user_data` is a string to stand in front of each line, which
 * lasts, or NULL. Leaves out infos and what was said before. The first LOG_LINES_PER_FILE messages
 * about a file are said, the others counted; a message is about the file that its words up to ": "
 * name. Control characters are written as text_write has them. Thread safety: any thread.
 */
void log_say(void *user_data, SluiceLogSeverity severity, const char *message);

/** Says how many messages were only counted, for each file, and begins anew. */
void log_finish(void);

#endif /* TOOLS_COMMON_LOG_H */
