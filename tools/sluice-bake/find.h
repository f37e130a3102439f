/** Which pictures there are, and where their stores go. */
#ifndef TOOLS_SLUICE_BAKE_FIND_H
#define TOOLS_SLUICE_BAKE_FIND_H

#include "../common/option_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct file {
    char *input, *output;
    uint64_t size; ///< bytes of the input, 0 if that is not known
};

struct files {
    struct file *files;
    size_t count, capacity;
    size_t unreadable_count; ///< folders and files in them, which were named on standard error
};

/**
 * Pictures named and found in folders, sorted by output. A folder holds pictures if their names
 * end as pictures' do; hidden ones and stores do not count. Links to folders are not
 * followed there. False, having said why, if two pictures would go to one file or there is no
 * memory.
 */
bool find_files(struct files *files, const struct option_list *inputs, const char *output);
void free_files(struct files *files);

#endif /* TOOLS_SLUICE_BAKE_FIND_H */
