#include "base/struct_size.h"

#include "base/log.h"

#include <string.h>

SluiceResult slc_struct_check(const struct slc_struct *type, const void *out,
                              const SluiceLogCallback *log)
{
    uint32_t size;
    memcpy(&size, out, sizeof size);
    if (size >= type->least && size <= SLC_MAX_STRUCT_SIZE)
        return SLUICE_SUCCESS;
    return slc_log_refusal(
        log, "%s: structSize is %u; it must be sizeof(%s), here %u, and %u to %u", type->name, size,
        type->name, type->size, type->least, SLC_MAX_STRUCT_SIZE);
}

SluiceResult slc_struct_read(const struct slc_struct *type, void *to, const void *from,
                             const SluiceLogCallback *log)
{
    SluiceResult result = slc_struct_check(type, from, log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t size;
    memcpy(&size, from, sizeof size);
    const unsigned char *bytes = from;
    for (uint32_t i = type->size; i < size; i++) {
        if (bytes[i]) {
            slc_log(log, SLUICE_LOG_ERROR,
                    "%s: byte %u is not 0: it belongs to a field of a newer version, which this "
                    "one (%u bytes) does not have",
                    type->name, i, type->size);
            return SLUICE_ERROR_UNSUPPORTED;
        }
    }
    uint32_t known = size < type->size ? size : type->size;
    memcpy(to, from, known);
    memset((unsigned char *)to + known, 0, type->size - known);
    memcpy(to, &type->size, sizeof type->size);
    return SLUICE_SUCCESS;
}

void slc_struct_write(const struct slc_struct *type, void *out, const void *from)
{
    uint32_t size;
    memcpy(&size, out, sizeof size);
    uint32_t known = size < type->size ? size : type->size;
    memmove(out, from, known);
    memset((unsigned char *)out + known, 0, size - known);
    memcpy(out, &size, sizeof size);
}
