/** Names that a run keeps for its outputs, one for each. Any thread. */
#ifndef TOOLS_COMMON_OUTPUT_NAMES_H
#define TOOLS_COMMON_OUTPUT_NAMES_H

#include <stdbool.h>

enum output_name_owner {
    OUTPUT_NAME_OF_PROGRAM, ///< The program writes the file with output_file_begin.
    OUTPUT_NAME_OF_LIBRARY, ///< A library writes it.
};

enum output_name_answer { OUTPUT_NAME_FREE, OUTPUT_NAME_TAKEN, OUTPUT_NAME_NO_MEMORY };

/**
 * Keeps a name, or finds that it is kept for another output. Names are the same if they lead to the
 * same folder and end in the same word. A name whose folder does not exist is free.
 */
enum output_name_answer output_name_take(const char *path, enum output_name_owner owner);

/** Returns whether a name is kept for a file that a library writes. */
bool output_name_is_of_library(const char *path);

#endif /* TOOLS_COMMON_OUTPUT_NAMES_H */
