/** Folders of the operating system: as platform/file.h. */
#ifndef SLC_PLATFORM_FOLDER_H
#define SLC_PLATFORM_FOLDER_H

#include "platform/file.h"

/** Makes a folder that others may not read. EEXIST: it is there. */
bool slc_folder_make(const char *path);
/** True if any user may write in a folder. False also if there is none, and on Windows. */
bool slc_folder_is_open_to_all(const char *path);

/** A descriptor of the folder for slc_folder_sync, or -1. Close it with slc_file_close. */
int slc_folder_open(const char *path);
/** Waits until names are on the disk. True also if the file system needs or knows no such call. */
bool slc_folder_sync(int descriptor);

/** The entries of a folder, one after another. One thread at a time. */
struct slc_folder;

/** Begins to list. NULL: failed. */
struct slc_folder *slc_folder_begin(const char *path);
/** The next name, valid until the next call. NULL: errno is 0 at the end. */
const char *slc_folder_next(struct slc_folder *folder);
/** The status of an entry. Of the link itself if `of_link`. */
bool slc_folder_get_status(struct slc_folder *folder, const char *name, bool of_link,
                           struct slc_file_status *status);
/** Removes a file. */
bool slc_folder_remove(struct slc_folder *folder, const char *name);
/** NULL is allowed. */
void slc_folder_end(struct slc_folder *folder);

#endif /* SLC_PLATFORM_FOLDER_H */
