/** Says in the log why an argument is refused. */
#ifndef SLC_DEMAND_VULKAN_REFUSED_ARGUMENTS_H
#define SLC_DEMAND_VULKAN_REFUSED_ARGUMENTS_H

#include "demand_vulkan/loader.h"

/** Logs a message that begins with the name of the function. Returns INVALID_ARGUMENT. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
SluiceResult
slc_demand_refuse(const SluiceDemandLoader *loader, const char *function, const char *format, ...);

/** Refuses a ticket that the loader has not handed out. */
SluiceResult slc_demand_refuse_ticket(const SluiceDemandLoader *loader, const char *function,
                                      SluiceDemandTicket ticket);

/** Refuses a grid in calls that do not accept grids. */
SluiceResult slc_demand_refuse_grid(const SluiceDemandLoader *loader, const char *function,
                                    SluiceDemandTextureId id);

#endif /* SLC_DEMAND_VULKAN_REFUSED_ARGUMENTS_H */
