#include "platform/folder.h"

#include "platform/status_windows.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_NAME (3 * MAX_PATH) /* bytes of UTF-8 for a name of MAX_PATH units */

struct slc_folder {
    HANDLE search;
    WIN32_FIND_DATAW found;
    bool is_first; ///< `found` was not returned yet
    char path[SLC_WIDE_PATH];
    char name[MAX_NAME];
};

bool slc_folder_make(const char *path)
{
    WCHAR wide[SLC_WIDE_PATH];
    return slc_widen_path(path, wide) && (CreateDirectoryW(wide, NULL) || slc_fail_windows());
}

bool slc_folder_is_open_to_all(const char *path)
{
    (void)path;
    return false;
}

int slc_folder_open(const char *path)
{
    return slc_open_windows(path, FILE_LIST_DIRECTORY, OPEN_EXISTING, 0, _O_RDONLY);
}

/* Does nothing: names are on the disk when slc_path_replace returns. */
bool slc_folder_sync(int descriptor)
{
    (void)descriptor;
    return true;
}

/* Makes "FOLDER/NAME" in `path`. False: too long. */
static bool join(const struct slc_folder *folder, const char *name, char path[SLC_WIDE_PATH])
{
    int length = snprintf(path, SLC_WIDE_PATH, "%s/%s", folder->path, name);
    errno = ENAMETOOLONG;
    return length > 0 && length < SLC_WIDE_PATH;
}

static bool begin(struct slc_folder *folder, const char *path)
{
    char pattern[SLC_WIDE_PATH];
    WCHAR wide[SLC_WIDE_PATH];
    int length = snprintf(folder->path, sizeof folder->path, "%s", path);
    errno = ENAMETOOLONG;
    if (length < 0 || (size_t)length >= sizeof folder->path || !join(folder, "*", pattern) ||
        !slc_widen_path(pattern, wide))
        return false;
    folder->search = FindFirstFileW(wide, &folder->found);
    folder->is_first = true;
    return folder->search != INVALID_HANDLE_VALUE || slc_fail_windows();
}

struct slc_folder *slc_folder_begin(const char *path)
{
    struct slc_folder *folder = calloc(1, sizeof *folder);
    if (folder && !begin(folder, path)) {
        free(folder);
        folder = NULL;
    }
    return folder;
}

const char *slc_folder_next(struct slc_folder *folder)
{
    if (!folder->is_first && !FindNextFileW(folder->search, &folder->found)) {
        errno = 0;
        if (GetLastError() != ERROR_NO_MORE_FILES)
            slc_fail_windows();
        return NULL;
    }
    folder->is_first = false;
    if (WideCharToMultiByte(CP_UTF8, 0, folder->found.cFileName, -1, folder->name, MAX_NAME, NULL,
                            NULL) > 0)
        return folder->name;
    slc_fail_windows();
    return NULL;
}

bool slc_folder_get_status(struct slc_folder *folder, const char *name, bool of_link,
                           struct slc_file_status *status)
{
    char path[SLC_WIDE_PATH];
    return join(folder, name, path) &&
           (of_link ? slc_path_get_link_status(path, status) : slc_path_get_status(path, status));
}

bool slc_folder_remove(struct slc_folder *folder, const char *name)
{
    char path[SLC_WIDE_PATH];
    return join(folder, name, path) && slc_path_remove(path);
}

void slc_folder_end(struct slc_folder *folder)
{
    if (!folder)
        return;
    FindClose(folder->search);
    free(folder);
}
