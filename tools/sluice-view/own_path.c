/* readlink */
#define _XOPEN_SOURCE 700

#include "own_path.h"

#include <string.h>
#include <unistd.h>

bool own_path(char *path, size_t size)
{
    const ssize_t length = readlink("/proc/self/exe", path, size - 1);
    path[length > 0 ? length : 0] = '\0';
    return length > 0;
}

bool own_folder(char *folder, size_t size)
{
    if (!own_path(folder, size))
        return false;
    *strrchr(folder, '/') = '\0';
    return true;
}
