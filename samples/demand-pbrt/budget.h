/** Which meshes leave when their memory is short. */
#ifndef DEMAND_PBRT_BUDGET_H
#define DEMAND_PBRT_BUDGET_H

#include "world.h"

/**
 * Marks meshes to leave, those first that no launch has hit for longest, until the others fit into
 * the budget. Meshes that this launch has built stay. `*fits`: they do fit.
 */
bool budget_make_room(struct world *world, uint32_t launch, bool *fits);

#endif /* DEMAND_PBRT_BUDGET_H */
