/** Observer of a manager's calls, for recorders: inputs and outputs, call by call. */
#ifndef SLC_CORE_OBSERVER_H
#define SLC_CORE_OBSERVER_H

#include "core/calls.h"

/** Sets the only observer. A zeroed observer: none. */
void slc_manager_set_observer(SluiceStreamedTextureManager *manager, struct slc_observer observer);

/** Tells the observer, if there is one. */
void slc_notify(SluiceStreamedTextureManager *manager, const struct slc_call *call);

/** True if a changing call other than sluiceSetConfig was made. */
bool slc_manager_is_used(const SluiceStreamedTextureManager *manager);

/** True if the manager has an observer. */
bool slc_manager_is_observed(const SluiceStreamedTextureManager *manager);

/** Returns the create-info, with which a player makes an equal manager. */
const SluiceStreamedTextureManagerCreateInfo *
slc_manager_create_info(const SluiceStreamedTextureManager *manager);

/** Returns the configuration that sluiceSetConfig was given last; all 0 before. */
const SluiceStreamedTextureManagerConfig *
slc_manager_config(const SluiceStreamedTextureManager *manager);

/** Sets the configuration of a snapshot. Does not notify the observer. */
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
