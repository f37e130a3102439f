/** Included before every source of the tools for Windows: what they use of POSIX and MinGW-w64
 * lacks. */
#ifndef TOOLS_COMMON_POSIX_ON_WINDOWS_H
#define TOOLS_COMMON_POSIX_ON_WINDOWS_H

#include <direct.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stddef.h>
#include <sys/stat.h>

/* A pipe or a device is never opened by its name there. */
#define O_NONBLOCK 0
#define O_NOCTTY 0
#define O_CLOEXEC (_O_NOINHERIT | _O_BINARY)
#define F_DUPFD_CLOEXEC 0

/** Duplicates a descriptor. The lower bound of the new number is not kept. */
static inline int fcntl(int descriptor, int command, int least)
{
    (void)command;
    (void)least;
    return _dup(descriptor);
}

/** Follows links: nothing here makes them on Windows. */
#define lstat stat
#define mkdir(path, permissions) _mkdir(path)

char *strndup(const char *text, size_t length);

int alphasort(const struct dirent **a, const struct dirent **b);
/** Entries of a folder, sorted. `select` is NULL. */
int scandir(const char *folder, struct dirent ***entries, int (*select)(const struct dirent *),
            int (*compare)(const struct dirent **, const struct dirent **));

#endif /* TOOLS_COMMON_POSIX_ON_WINDOWS_H */
