#include "core/refusal.h"

#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

SluiceResult slc_refuse(const slc_manager *m, const char *function, const char *format, ...)
{
    char why[256];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    return slc_log_refusal(&m->info.log, "%s: %s", function, why);
}

SluiceResult slc_refuse_locked(const slc_manager *m, const char *function)
{
    return slc_refuse(m, function,
                      "the manager is locked: only its owner, such as a streamer, "
                      "may call this");
}
