#include "base/same_file.h"

#include "platform/file.h"

#include <stdio.h>

bool slc_is_same_file(const char *a, const char *b)
{
    struct slc_file_status first, second;
    return slc_path_get_status(a, &first) && slc_path_get_status(b, &second) &&
           first.kind == SLC_NODE_FILE && first.device == second.device &&
           first.inode == second.inode;
}

bool slc_output_replaces_input(const char *output, const char *input)
{
    char part[4200]; /* the system opens no longer paths */
    int length = snprintf(part, sizeof part, "%s.sluice-part", output);
    return slc_is_same_file(output, input) ||
           (length > 0 && (size_t)length < sizeof part && slc_is_same_file(part, input));
}
