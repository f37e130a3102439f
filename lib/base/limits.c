#include "base/limits.h"

#include "base/log.h"

SluiceResult slc_check_limits(const SluiceLogCallback *log, const struct slc_limit *limits,
                              size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct slc_limit *l = &limits[i];
        if (l->value < l->least || l->value > l->most)
            return slc_log_refusal(log, "%s is %llu; it must be from %llu to %llu", l->field,
                                   (unsigned long long)l->value, (unsigned long long)l->least,
                                   (unsigned long long)l->most);
    }
    return SLUICE_SUCCESS;
}
