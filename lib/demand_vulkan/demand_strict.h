/** Reports of misuse. Each function does nothing unless strict mode is on. */
#ifndef SLC_DEMAND_VULKAN_DEMAND_STRICT_H
#define SLC_DEMAND_VULKAN_DEMAND_STRICT_H

#include "demand_vulkan/loader.h"

void slc_demand_strict_not_ended(SluiceDemandLoader *loader);
void slc_demand_strict_not_begun(SluiceDemandLoader *loader);
/** Nanoseconds of `timeout` that a call may wait before slc_demand_strict_not_ready has something
 *  to report. */
uint64_t slc_demand_strict_patience(SluiceDemandLoader *loader, uint64_t launch, uint64_t timeout);
/** A call is not ready, or has waited as long as slc_demand_strict_patience said. */
void slc_demand_strict_not_ready(SluiceDemandLoader *loader, uint64_t launch);
/** True if shaders are to report what `launch` uses, for strict mode alone. */
bool slc_demand_strict_probes(const SluiceDemandLoader *loader, uint64_t launch);
/** A launch was processed. `marked`: shaders requested or used pages. `turned_away`: pages of
 *  resources that found no memory. */
void slc_demand_strict_processed(SluiceDemandLoader *loader, bool marked, uint64_t turned_away);
/** A texture is refused because there are maxTextureCount. */
void slc_demand_strict_no_texture(SluiceDemandLoader *loader);
/** `name`: of an image that finds no virtual pages. */
void slc_demand_strict_no_ids(SluiceDemandLoader *loader, const char *name);

#endif /* SLC_DEMAND_VULKAN_DEMAND_STRICT_H */
