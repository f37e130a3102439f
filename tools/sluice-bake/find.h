/** Finds the input pictures and the paths of their stores. */
#ifndef TOOLS_SLUICE_BAKE_FIND_H
#define TOOLS_SLUICE_BAKE_FIND_H

#include "../common/option_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct file {
    char *input, *output;
    uint64_t size; ///< bytes of the input; 0: unknown
};

struct files {
    struct file *files;
    size_t count, capacity;
    size_t unreadable_count; ///< unreadable folders, and files in folders; all named on stderr
};

/**
 * Lists the named pictures and the pictures in named folders, sorted by output. In a folder, files
 * count by their extension; hidden files and stores do not. Links to folders are not followed
 * there. Returns false if two pictures have one output, or when out of memory, and reports it on
 * stderr.
 */
bool find_files(struct files *files, const struct option_list *inputs, const char *output);
void free_files(struct files *files);

#endif /* TOOLS_SLUICE_BAKE_FIND_H */
