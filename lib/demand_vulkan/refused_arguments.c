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
    slc_log(&loader->vk.log, SLUICE_LOG_ERROR, "%s: %s", function, why);
    return SLUICE_ERROR_INVALID_ARGUMENT;
}

SluiceResult slc_demand_refuse_grid(const SluiceDemandLoader *loader, const char *function,
                                    SluiceDemandTextureId id)
{
    return slc_demand_refuse(loader, function, "texture %#" PRIx64 " is a grid", id);
}
