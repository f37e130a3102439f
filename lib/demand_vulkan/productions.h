/**
 * Tiles and byte pages that commands of the application write. A page with a place waits for the
 * next launch, which calls its producer. The page is shown by the first launch that begins after
 * that launch was processed, because the producer of an abandoned launch may answer otherwise when
 * it is called again (docs/decisions/0079-produced-tiles-are-remade-in-place.md).
 */
#ifndef SLC_DEMAND_VULKAN_PRODUCTIONS_H
#define SLC_DEMAND_VULKAN_PRODUCTIONS_H

#include "demand_vulkan/loader.h"

/** Allocates the lists. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_productions_init(SluiceDemandLoader *loader);
void slc_productions_finish(SluiceDemandLoader *loader);

/** Begins to make a resident page again. A job must be ready. The key was taken from `remakes`. */
void slc_remake_begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                      struct slc_demand_resource *resource, uint32_t page);

/** Makes pages resident that launches up to `processed` wrote. Call it before changes are applied.
 */
void slc_productions_collect(SluiceDemandLoader *loader);
/** True if the launch will call producers. */
bool slc_productions_are_due(const SluiceDemandLoader *loader);
/** Calls producers, after the copies of the launch. Returns how many pages are written. */
uint32_t slc_productions_ask(SluiceDemandLoader *loader, VkCommandBuffer commands);
/** Calls producers again for pages of launches from this one on, which never run. */
void slc_productions_ask_again(SluiceDemandLoader *loader, uint64_t launch);

/* remaking.c */
/** Moves pages from `remakes` into jobs, while jobs are free for remakes. */
void slc_remakes_start(SluiceDemandLoader *loader);

#endif /* SLC_DEMAND_VULKAN_PRODUCTIONS_H */
