/**
 * Pages that commands of the application fill, tiles and byte pages. A page that got a place waits
 * for the next launch, which asks its producer. The page is shown by the first launch that begins
 * after that launch was processed: the producer of an abandoned launch may answer otherwise when it
 * is asked again (docs/decisions/0079-produced-tiles-are-remade-in-place.md).
 */
#ifndef SLC_DEMAND_VULKAN_PRODUCTIONS_H
#define SLC_DEMAND_VULKAN_PRODUCTIONS_H

#include "demand_vulkan/loader.h"

/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_productions_init(SluiceDemandLoader *loader);
void slc_productions_finish(SluiceDemandLoader *loader);

/** A job that is ready makes a resident page again. Its key is taken from `remakes`. */
void slc_remake_begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                      struct slc_demand_resource *resource, uint32_t page);

/** Pages that launches up to `processed` wrote are resident. Before changes are applied. */
void slc_productions_collect(SluiceDemandLoader *loader);
/** The launch will ask producers. */
bool slc_productions_are_due(const SluiceDemandLoader *loader);
/** Asks producers for pages, after the copies of the launch. Returns how many are written. */
uint32_t slc_productions_ask(SluiceDemandLoader *loader, VkCommandBuffer commands);
/** Launches from this one on never run: asks again for what they wrote. */
void slc_productions_ask_again(SluiceDemandLoader *loader, uint64_t launch);

/* remaking.c */
/** Takes pages that are to be made again into jobs, as far as these may have them. */
void slc_remakes_start(SluiceDemandLoader *loader);

#endif /* SLC_DEMAND_VULKAN_PRODUCTIONS_H */
