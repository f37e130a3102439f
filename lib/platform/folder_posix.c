#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "platform/folder.h"

#include "platform/status_posix.h"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

bool slc_folder_make(const char *path)
{
    return mkdir(path, 0700) == 0;
}

bool slc_folder_is_open_to_all(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && (status.st_mode & S_IWOTH);
}

int slc_folder_open(const char *path)
{
    return open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

bool slc_folder_sync(int descriptor)
{
    return fsync(descriptor) == 0 || errno == EINVAL; /* EINVAL: not supported and not needed */
}

/* Converts to DIR, the system's type behind struct slc_folder. */
static DIR *native(struct slc_folder *folder)
{
    return (DIR *)folder;
}

struct slc_folder *slc_folder_begin(const char *path)
{
    return (struct slc_folder *)opendir(path);
}

const char *slc_folder_next(struct slc_folder *folder)
{
    errno = 0;
    const struct dirent *entry = readdir(native(folder));
    return entry ? entry->d_name : NULL;
}

bool slc_folder_get_status(struct slc_folder *folder, const char *name, bool of_link,
                           struct slc_file_status *status)
{
    struct stat answer;
    if (fstatat(dirfd(native(folder)), name, &answer, of_link ? AT_SYMLINK_NOFOLLOW : 0) != 0)
        return false;
    slc_read_stat(&answer, status);
    return true;
}

bool slc_folder_remove(struct slc_folder *folder, const char *name)
{
    return unlinkat(dirfd(native(folder)), name, 0) == 0;
}

void slc_folder_end(struct slc_folder *folder)
{
    if (folder)
        closedir(native(folder));
}
