/** A file that appears under its name only when it is complete. */
#ifndef SLC_REPLAY_RECORD_FILE_H
#define SLC_REPLAY_RECORD_FILE_H

#include <sluice/base.h>

struct slc_record_file;

/** Opens `path` with ".partial" appended. Errors: IO, OUT_OF_HOST_MEMORY. */
SluiceResult slc_record_file_open(const SluiceAllocationCallbacks *cb, const char *path,
                                  struct slc_record_file **file);

/** A SluiceRecordWriter's function; `file` is the struct. Errors: IO. */
SluiceResult slc_record_file_write(void *file, const void *data, size_t size);

/** Gives the file its name, or, where `keep` is false or that fails, removes it. NULL is allowed.
 */
SluiceResult slc_record_file_close(struct slc_record_file *file, bool keep);

#endif /* SLC_REPLAY_RECORD_FILE_H */
