/** Ranges of the fields of a struct that the caller fills. */
#ifndef SLC_BASE_LIMITS_H
#define SLC_BASE_LIMITS_H

#include <sluice/base.h>

/** A field, defaults filled in. */
struct slc_limit {
    const char *field;
    uint64_t value, least, most;
};

/** Logs the first field that is outside its limits. Errors: INVALID_ARGUMENT. */
SluiceResult slc_check_limits(const SluiceLogCallback *log, const struct slc_limit *limits,
                              size_t count);

#endif /* SLC_BASE_LIMITS_H */
