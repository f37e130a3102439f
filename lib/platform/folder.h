/** Folders of the operating system. Conventions: see platform/file.h. */
#ifndef SLC_PLATFORM_FOLDER_H
#define SLC_PLATFORM_FOLDER_H

#include "platform/file.h"

/** Creates a folder without access for other users. EEXIST: the folder exists. */
bool slc_folder_make(const char *path);
/** Tells whether any user may write in a folder. False for a missing folder, and on Windows. */
bool slc_folder_is_open_to_all(const char *path);

/** Returns a descriptor for slc_folder_sync, or -1. Close with slc_file_close. */
int slc_folder_open(const char *path);
/** Waits until names are on the disk. True also for file systems without such a call. */
bool slc_folder_sync(int descriptor);

/** Iterator over the entries of a folder. One thread at a time. */
struct slc_folder;

/** Begins to list a folder. NULL: failure. */
struct slc_folder *slc_folder_begin(const char *path);
/** Returns the next name, valid until the next call. NULL: the end (errno 0) or an error. */
const char *slc_folder_next(struct slc_folder *folder);
/** Gets the status of an entry, or of the link itself if `of_link`. */
bool slc_folder_get_status(struct slc_folder *folder, const char *name, bool of_link,
                           struct slc_file_status *status);
/** Removes a file. */
bool slc_folder_remove(struct slc_folder *folder, const char *name);
/** Ends the listing. NULL is allowed. */
void slc_folder_end(struct slc_folder *folder);

#endif /* SLC_PLATFORM_FOLDER_H */
