#define _XOPEN_SOURCE 700
#include "folders.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "memory.h"

#define OPEN_FOLDERS 16

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    (void)place;
    return remove(path);
}

bool folders_exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool folders_remove(const char *path)
{
    return nftw(path, remove_entry, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS) == 0 || errno == ENOENT;
}

bool folders_make_empty(const char *path)
{
    return folders_remove(path) && mkdir(path, 0777) == 0;
}

bool folders_replace(const char *from, const char *to)
{
    return folders_remove(to) && rename(from, to) == 0;
}

bool folders_lock(const char *folder)
{
    char *path = memory_text("%s/lock", folder);
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    free(path);
    /* Stays open: the lock ends with the process. */
    return file >= 0 && fcntl(file, F_SETLK, &whole) == 0;
}
