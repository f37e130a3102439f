/**
 * Structs of the interface that may grow: their first field is `uint32_t structSize`, set by the
 * caller. Decision 47 has the rules.
 *
 * Every public function reads such a struct through slc_struct_read and writes it through
 * slc_struct_check and slc_struct_write.
 */
#ifndef SLC_BASE_STRUCT_SIZE_H
#define SLC_BASE_STRUCT_SIZE_H

#include "base/first_release.h"

#include <sluice/base.h>

/** Larger values of structSize are garbage: the caller has not set it. */
#define SLC_MAX_STRUCT_SIZE (1u << 16)

struct slc_struct {
    const char *name;
    uint32_t size;  ///< Bytes in this version.
    uint32_t least; ///< Bytes of the first release, without padding at the end.
};

#define SLC_STRUCT(type)                                                                           \
    (&(const struct slc_struct){#type, (uint32_t)sizeof(type), (uint32_t)SLC_FIRST_##type})

/**
 * Copies a struct of any structSize to `to`, which has this version's size. Fields that the caller
 * does not have become 0; `to`'s structSize becomes this version's. `log` may be NULL.
 *
 * Errors, logged, with `to` unchanged: SLUICE_ERROR_INVALID_ARGUMENT if structSize is below the
 * first release's size; SLUICE_ERROR_UNSUPPORTED if a byte beyond this version's size is not 0.
 */
SluiceResult slc_struct_read(const struct slc_struct *type, void *to, const void *from,
                             const SluiceLogCallback *log);

/** Checks the structSize of a struct to be written. Errors: SLUICE_ERROR_INVALID_ARGUMENT. */
SluiceResult slc_struct_check(const struct slc_struct *type, const void *out,
                              const SluiceLogCallback *log);

/**
 * Writes at most structSize bytes, and keeps structSize. Bytes that this version does not know
 * become 0. slc_struct_check has accepted `out`. `from` has this version's size, and may be `out`.
 */
void slc_struct_write(const struct slc_struct *type, void *out, const void *from);

#endif /* SLC_BASE_STRUCT_SIZE_H */
