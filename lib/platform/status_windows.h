/** What file_windows.c and folder_windows.c share. Each path is converted from UTF-8. */
#ifndef SLC_PLATFORM_STATUS_WINDOWS_H
#define SLC_PLATFORM_STATUS_WINDOWS_H

#include "platform/file.h"

#include <windows.h>

#define SLC_WIDE_PATH                                                                              \
    4096 /* Windows itself stops at 260 unless the machine was set up otherwise. */

/** Sets errno to what stands for GetLastError() and returns false. */
bool slc_fail_windows(void);

/** False, with errno set, if the path is too long or no UTF-8. */
bool slc_widen_path(const char *path, WCHAR wide[SLC_WIDE_PATH]);

/** Opens what is there, a folder too, and closes it on failure. -1: errno is set. */
int slc_open_windows(const char *path, DWORD access, DWORD creation, DWORD flags, int mode);

bool slc_read_handle_status(HANDLE handle, struct slc_file_status *status);

#endif /* SLC_PLATFORM_STATUS_WINDOWS_H */
