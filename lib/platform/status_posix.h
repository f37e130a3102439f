/** Converts results of stat. */
#ifndef SLC_PLATFORM_STATUS_POSIX_H
#define SLC_PLATFORM_STATUS_POSIX_H

#include "platform/file.h"

#include <sys/stat.h>

void slc_read_stat(const struct stat *from, struct slc_file_status *status);

#endif /* SLC_PLATFORM_STATUS_POSIX_H */
