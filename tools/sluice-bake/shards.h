/** Baking by plan: --plan, --shard and --merge. */
#ifndef TOOLS_SLUICE_BAKE_SHARDS_H
#define TOOLS_SLUICE_BAKE_SHARDS_H

#include "bake_plan.h"
#include "find.h"
#include "options.h"

/** Describes the pictures and writes options->plan. False if one cannot be described, which is left
 *  out and named on stderr, or the plan cannot be written. */
bool shards_plan(const struct options *options, const struct files *files);

/**
 * Reads the plan that is the only input, and puts the pictures of the shard options->shard into
 * `files`, whose names belong to `plan`. False if stderr says why.
 */
bool shards_choose(const struct options *options, struct plan *plan, struct files *files);

/**
 * Checks that all stores of the plan are there and fit it, and writes the catalogue
 * options->output. False, and no catalogue, if one is missing; stdout names those, and the shards
 * to run again.
 */
bool shards_merge(const struct options *options);

#endif /* TOOLS_SLUICE_BAKE_SHARDS_H */
