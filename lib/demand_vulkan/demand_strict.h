/** Reports of misuse. Each function does nothing unless strict mode is on. */
#ifndef SLC_DEMAND_VULKAN_DEMAND_STRICT_H
#define SLC_DEMAND_VULKAN_DEMAND_STRICT_H

#include "demand_vulkan/loader.h"

void slc_demand_strict_not_ended(SluiceDemandLoader *loader);
void slc_demand_strict_not_begun(SluiceDemandLoader *loader);
/** Returns the nanoseconds, at most `timeout`, that a call may wait before it must call
 *  slc_demand_strict_not_ready. */
uint64_t slc_demand_strict_patience(SluiceDemandLoader *loader, uint64_t launch, uint64_t timeout);
/** Notes a call that is not ready, or has waited as long as slc_demand_strict_patience allows. */
void slc_demand_strict_not_ready(SluiceDemandLoader *loader, uint64_t launch);
/** True if shaders must report the pages that `launch` uses, for strict mode only. */
bool slc_demand_strict_probes(const SluiceDemandLoader *loader, uint64_t launch);
/** Checks a processed launch. `marked`: shaders requested or used pages. `turned_away`: pages of
 *  resources that found no memory. */
void slc_demand_strict_processed(SluiceDemandLoader *loader, bool marked, uint64_t turned_away);
/** Reports a texture that is refused because there are maxTextureCount textures. */
void slc_demand_strict_no_texture(SluiceDemandLoader *loader);
/** Reports an image for which no page ids are left. `name`: name of the image. */
void slc_demand_strict_no_ids(SluiceDemandLoader *loader, const char *name);

#endif /* SLC_DEMAND_VULKAN_DEMAND_STRICT_H */
