/* folders */
#ifndef MACOS_STUB_DIRENT_H
#define MACOS_STUB_DIRENT_H

#include <sys/types.h>

typedef struct macos_stub_dir DIR;
struct dirent {
    ino_t d_ino;
    char d_name[1024];
};

int closedir(DIR *folder);
int dirfd(DIR *folder);
DIR *opendir(const char *path);
struct dirent *readdir(DIR *folder);

#endif /* MACOS_STUB_DIRENT_H */
