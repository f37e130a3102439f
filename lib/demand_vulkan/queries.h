/** Description of pages for queries: texture, level and tile. */
#ifndef SLC_DEMAND_VULKAN_QUERIES_H
#define SLC_DEMAND_VULKAN_QUERIES_H

#include "demand_vulkan/loader.h"

#include <sluice/demand_query.h>

/** Returns the description of a page for sluiceGetDemandMisses. */
SluiceDemandMiss slc_demand_miss_of(const SluiceDemandLoader *loader, uint32_t page);

#endif /* SLC_DEMAND_VULKAN_QUERIES_H */
