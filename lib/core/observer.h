/** What enters and leaves the core, call by call, for a recorder to write down. */
#ifndef SLC_CORE_OBSERVER_H
#define SLC_CORE_OBSERVER_H

#include "core/calls.h"

/** A zeroed observer switches off. One at a time. */
void slc_manager_set_observer(SluiceStreamedTextureManager *manager, struct slc_observer observer);

/** Tells the observer, if there is one. */
void slc_notify(SluiceStreamedTextureManager *manager, const struct slc_call *call);

/** Whether a changing call but sluiceSetConfig was made. */
bool slc_manager_is_used(const SluiceStreamedTextureManager *manager);

/** Whether an observer is there. */
bool slc_manager_is_observed(const SluiceStreamedTextureManager *manager);

/** Read only; what the player needs to make an equal manager. */
const SluiceStreamedTextureManagerCreateInfo *
slc_manager_create_info(const SluiceStreamedTextureManager *manager);

/** What sluiceSetConfig was given last; all 0 before. */
const SluiceStreamedTextureManagerConfig *
slc_manager_config(const SluiceStreamedTextureManager *manager);

/** Sets a configuration that a snapshot has. Tells nobody. */
void slc_manager_take_config(SluiceStreamedTextureManager *manager,
                             const SluiceStreamedTextureManagerConfig *config);

/** Returns how often sluiceSetConfig succeeded. */
uint64_t slc_manager_config_count(const SluiceStreamedTextureManager *manager);

/** Returns the number of the next request: tiles that become REQUESTED count from 0. */
uint64_t slc_manager_next_request(const SluiceStreamedTextureManager *manager);

/** Returns the number of the request of a tile that was just handed out; UINT64_MAX: nothing
 *  requested it. */
uint64_t slc_manager_request_of(const SluiceStreamedTextureManager *manager,
                                const SluiceTile *tile);

/** Returns statistics whose counts by state leave out tiles that take no slots. */
SluiceStreamedTextureStatistics
slc_manager_slot_statistics(const SluiceStreamedTextureManager *manager);

#endif /* SLC_CORE_OBSERVER_H */
