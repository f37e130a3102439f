/** POSIX functions that MinGW-w64 lacks. Included before every source of the tools on Windows. */
#ifndef TOOLS_COMMON_POSIX_ON_WINDOWS_H
#define TOOLS_COMMON_POSIX_ON_WINDOWS_H

#include <direct.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stddef.h>
#include <sys/stat.h>

/* Opening never blocks: there are no pipes or devices with names. */
#define O_NONBLOCK 0
#define O_NOCTTY 0
#define O_CLOEXEC (_O_NOINHERIT | _O_BINARY)
#define F_DUPFD_CLOEXEC 0

/** Duplicates a descriptor. Ignores the lower bound of the new number. */
static inline int fcntl(int descriptor, int command, int least)
{
    (void)command;
    (void)least;
    return _dup(descriptor);
}

/** Follows links, because the tools make none on Windows. */
#define lstat stat
#define mkdir(path, permissions) _mkdir(path)

char *strndup(const char *text, size_t length);

int alphasort(const struct dirent **a, const struct dirent **b);
/** Returns the entries of a folder, sorted. `select` must be NULL. */
int scandir(const char *folder, struct dirent ***entries, int (*select)(const struct dirent *),
            int (*compare)(const struct dirent **, const struct dirent **));

#endif /* TOOLS_COMMON_POSIX_ON_WINDOWS_H */
