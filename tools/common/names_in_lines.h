/** Names of files in text files of one line per entry, with tabs between the columns. */
#ifndef TOOLS_COMMON_NAMES_IN_LINES_H
#define TOOLS_COMMON_NAMES_IN_LINES_H

#include <stdbool.h>
#include <stdio.h>

/** Writes a name; \t, \n, \r and \\ stand for the characters that would end it. */
void line_write_name(FILE *out, const char *name);
/** Turns what line_write_name wrote back, in place. False if it is empty or no such name. */
bool line_read_name(char *name);

#endif /* TOOLS_COMMON_NAMES_IN_LINES_H */
