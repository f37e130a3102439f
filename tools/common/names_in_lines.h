/** File names in text files with one entry per line and tabs between columns. */
#ifndef TOOLS_COMMON_NAMES_IN_LINES_H
#define TOOLS_COMMON_NAMES_IN_LINES_H

#include <stdbool.h>
#include <stdio.h>

/** Writes a name. Escapes tab, newline, carriage return and backslash as \t, \n, \r and \\. */
void line_write_name(FILE *out, const char *name);
/** Decodes a name of line_write_name, in place. Returns false if it is empty or malformed. */
bool line_read_name(char *name);

#endif /* TOOLS_COMMON_NAMES_IN_LINES_H */
