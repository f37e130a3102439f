/** Detection of an output file that is also an input. */
#ifndef SLC_BASE_SAME_FILE_H
#define SLC_BASE_SAME_FILE_H

#include <stdbool.h>

/** True if both name the same regular file, also through symbolic and hard links. */
bool slc_is_same_file(const char *a, const char *b);

/** True if writing `output` with slc_part_file_open would replace or empty `input`: `input` is the
 *  file at `output` or at `output` with ".sluice-part" added. */
bool slc_output_replaces_input(const char *output, const char *input);

#endif /* SLC_BASE_SAME_FILE_H */
