#include "store/store_file.h"

#include "base/log.h"
#include "base/system.h"
#include "platform/file.h"

#include <string.h>

SluiceResult slc_store_fail_at(const struct slc_store_file *file, SluiceResult result,
                               uint64_t offset, const char *what)
{
    slc_log(&file->log, SLUICE_LOG_ERROR, "%s: at %llu: %s", file->path, (unsigned long long)offset,
            what);
    return result;
}

SluiceResult slc_store_file_read(const struct slc_store_file *file, uint64_t offset, void *bytes,
                                 size_t size)
{
    size_t done = 0;
    while (done < size) {
        int64_t got =
            slc_file_read_at(file->descriptor, offset + done, (char *)bytes + done, size - done);
        if (got == 0)
            return slc_store_fail_at(file, SLUICE_ERROR_IO, offset + done,
                                     "the file ends here; it has become shorter");
        if (got > 0)
            done += (size_t)got;
        else if (errno != EINTR)
            return slc_store_fail_at(file, slc_system_result(errno), offset + done,
                                     strerror(errno));
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_file_write(const struct slc_store_file *file, uint64_t offset,
                                  const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        int64_t put = slc_file_write_at(file->descriptor, offset + done, (const char *)bytes + done,
                                        size - done);
        if (put > 0)
            done += (size_t)put;
        else if (put == 0 || errno != EINTR)
            return slc_store_fail_at(file, SLUICE_ERROR_IO, offset + done,
                                     put ? strerror(errno) : "nothing can be written");
    }
    return SLUICE_SUCCESS;
}
