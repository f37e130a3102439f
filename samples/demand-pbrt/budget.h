/** Evicts meshes and materials to stay within their memory budgets. */
#ifndef DEMAND_PBRT_BUDGET_H
#define DEMAND_PBRT_BUDGET_H

#include "world.h"

/**
 * Marks meshes for eviction, least recently hit first, until the remaining meshes fit into the
 * budget. Meshes built in this launch are kept. `*fits`: whether the remaining meshes fit.
 */
bool budget_make_room(struct world *world, uint32_t launch, bool *fits);

/**
 * Evicts surfaces, least recently hit first, until the remaining surfaces fit into their budget.
 * Surfaces made for this launch are kept. `*fits`: whether the remaining surfaces fit. Call only
 * while no launch is running. Reports errors on stderr.
 */
bool budget_make_surface_room(const struct world *world, struct surfaces *surfaces, uint32_t launch,
                              bool *fits);

#endif /* DEMAND_PBRT_BUDGET_H */
