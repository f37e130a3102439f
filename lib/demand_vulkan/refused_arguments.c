#include "demand_vulkan/refused_arguments.h"

#include "base/log.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

SluiceResult slc_demand_refuse(const SluiceDemandLoader *loader, const char *function,
                               const char *format, ...)
{
    char why[256];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    return slc_log_refusal(&loader->vk.log, "%s: %s", function, why);
}

SluiceResult slc_demand_refuse_grid(const SluiceDemandLoader *loader, const char *function,
                                    SluiceDemandTextureId id)
{
    return slc_demand_refuse(loader, function, "texture %#" PRIx64 " is a grid", id);
}

SluiceResult slc_demand_refuse_ticket(const SluiceDemandLoader *loader, const char *function,
                                      SluiceDemandTicket ticket)
{
    return slc_demand_refuse(loader, function,
                             "ticket is %" PRIu64 "; the loader has not handed it out", ticket);
}
