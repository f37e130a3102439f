/** Which meshes and materials leave when their memory is short. */
#ifndef DEMAND_PBRT_BUDGET_H
#define DEMAND_PBRT_BUDGET_H

#include "world.h"

/**
 * Marks meshes to leave, those first that no launch has hit for longest, until the others fit into
 * the budget. Meshes that this launch has built stay. `*fits`: they do fit.
 */
bool budget_make_room(struct world *world, uint32_t launch, bool *fits);

/**
 * Evicts surfaces that no launch has hit for longest, until the others fit into their budget. Those
 * made for this launch stay. `*fits`: they do fit. No launch is under way. Says on stderr why it
 * failed.
 */
bool budget_make_surface_room(const struct world *world, struct surfaces *surfaces, uint32_t launch,
                              bool *fits);

#endif /* DEMAND_PBRT_BUDGET_H */
