/** Names of the files that this run writes, each of which it writes once. Any thread. */
#ifndef TOOLS_COMMON_OUTPUT_NAMES_H
#define TOOLS_COMMON_OUTPUT_NAMES_H

enum output_name_use {
    OUTPUT_NAME_PROMISED, ///< The run will begin the file later.
    OUTPUT_NAME_BEGUN,    ///< The run writes it now. Takes up a promise.
    OUTPUT_NAME_CLAIMED,  ///< A library writes it.
};

enum output_name_answer { OUTPUT_NAME_FREE, OUTPUT_NAME_TAKEN, OUTPUT_NAME_NO_MEMORY };

/**
 * Remembers a name, or finds that the run has given it to another file. Names are the same if they
 * lead to the same folder and end in the same word. A name whose folder does not exist is free.
 */
enum output_name_answer output_name_take(const char *path, enum output_name_use use);

/** Forgets a name, after its file could not be written. */
void output_name_give_back(const char *path);

#endif /* TOOLS_COMMON_OUTPUT_NAMES_H */
