#define _XOPEN_SOURCE 700
#include "folders.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../common/output_file.h"
#include "../common/text.h"
#include "memory.h"

#define OPEN_FOLDERS 16
#define MARK "made-by-sluice-tradeoff.txt"

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

static char *mark_of(const char *path)
{
    return memory_text("%s/" MARK, path);
}

static bool has_mark(const char *path)
{
    struct stat folder, file;
    char *mark = mark_of(path);
    bool has = lstat(path, &folder) == 0 && S_ISDIR(folder.st_mode) && lstat(mark, &file) == 0 &&
               S_ISREG(file.st_mode);
    free(mark);
    return has;
}

static bool is_empty(const char *path)
{
    DIR *folder = opendir(path);
    bool empty = folder != NULL;
    for (struct dirent *entry; empty && (entry = readdir(folder));)
        empty = strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0;
    if (folder)
        closedir(folder);
    return empty;
}

bool folders_make_own(const char *path)
{
    if (mkdir(path, 0777) != 0 && !folders_exists(path)) {
        text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
        return false;
    }
    if (!is_empty(path))
        return true;
    char *mark = mark_of(path);
    bool marked = output_file_print(mark, "sluice-tradeoff made this folder: --fresh removes it "
                                          "with everything in it.\n");
    free(mark);
    return marked;
}

bool folders_may_forget(const char *path)
{
    struct stat info;
    if (has_mark(path) || (lstat(path, &info) != 0 && errno == ENOENT))
        return true;
    text_say("sluice-tradeoff: %s: has no file " MARK " in it, so somebody else made it, or an "
             "older version: --fresh leaves it alone; remove it yourself, or name another folder "
             "with --results",
             path);
    return false;
}

/* Removes an entry, except the folder itself and its mark. With the mark, an interrupted removal
 * can be repeated. */
static int forget_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    bool stays = place->level == 0 || (place->level == 1 && strcmp(path + place->base, MARK) == 0);
    return stays ? 0 : remove(path);
}

bool folders_forget(const char *path)
{
    if (!has_mark(path))
        return folders_may_forget(path);
    char *mark = mark_of(path);
    bool gone = nftw(path, forget_entry, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS) == 0 &&
                unlink(mark) == 0 && rmdir(path) == 0;
    if (!gone)
        text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    free(mark);
    return gone;
}

char *folders_make_scratch(const char *results)
{
    char *path = memory_text("%s/runs/asked.partial", results);
    if (folders_make_empty(path))
        return path;
    text_say("sluice-tradeoff: %s: %s", path, strerror(errno));
    free(path);
    return NULL;
}

void folders_remove_scratch(char *path)
{
    if (path)
        folders_remove(path);
    free(path);
}

bool folders_lock(const char *folder)
{
    char *path = memory_text("%s/lock", folder);
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    int file = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    free(path);
    if (file >= 0 && file <= STDERR_FILENO) { /* messages go to descriptors 0 to 2 */
        int standard = file;
        file = fcntl(standard, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
        close(standard);
    }
    /* Keep the file open: the lock ends with the process. */
    return file >= 0 && fcntl(file, F_SETLK, &whole) == 0;
}
