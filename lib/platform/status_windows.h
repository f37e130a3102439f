/** Helpers of file_windows.c and folder_windows.c. Paths are converted from UTF-8. */
#ifndef SLC_PLATFORM_STATUS_WINDOWS_H
#define SLC_PLATFORM_STATUS_WINDOWS_H

#include "platform/file.h"

#include <windows.h>

#define SLC_WIDE_PATH 4096 /* Windows limits paths to 260 unless configured otherwise. */

/** Sets errno to the equivalent of GetLastError() and returns false. */
bool slc_fail_windows(void);

/** Converts a path. False, with errno: too long or not UTF-8. */
bool slc_widen_path(const char *path, WCHAR wide[SLC_WIDE_PATH]);

/** Opens a file or folder and returns a descriptor. -1: errno is set. */
int slc_open_windows(const char *path, DWORD access, DWORD creation, DWORD flags, int mode);

bool slc_read_handle_status(HANDLE handle, struct slc_file_status *status);

#endif /* SLC_PLATFORM_STATUS_WINDOWS_H */
