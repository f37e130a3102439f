#define _POSIX_C_SOURCE 200809L

#include "base/same_file.h"

#include <stdio.h>
#include <sys/stat.h>

bool slc_is_same_file(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && S_ISREG(first.st_mode) &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

bool slc_output_replaces_input(const char *output, const char *input)
{
    char part[4200]; /* the system opens no longer paths */
    int length = snprintf(part, sizeof part, "%s.sluice-part", output);
    return slc_is_same_file(output, input) ||
           (length > 0 && (size_t)length < sizeof part && slc_is_same_file(part, input));
}
