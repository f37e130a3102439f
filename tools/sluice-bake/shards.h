/** Baking by plan: --plan, --shard and --merge. */
#ifndef TOOLS_SLUICE_BAKE_SHARDS_H
#define TOOLS_SLUICE_BAKE_SHARDS_H

#include "bake_plan.h"
#include "find.h"
#include "options.h"

/** Describes the pictures and writes options->plan. Leaves out a picture that cannot be described
 * and reports it on stderr. Returns false then, or if the plan cannot be written. */
bool shards_plan(const struct options *options, const struct files *files);

/**
 * Reads the plan, which must be the only input, and puts the pictures of options->shard into
 * `files`, whose names belong to `plan`. Reports errors on stderr.
 */
bool shards_choose(const struct options *options, struct plan *plan, struct files *files);

/**
 * Checks that all stores of the plan exist and fit it, and writes the catalogue options->output. If
 * one is missing, writes no catalogue, prints the missing ones and the shards to run again on
 * stdout, and returns false.
 */
bool shards_merge(const struct options *options);

#endif /* TOOLS_SLUICE_BAKE_SHARDS_H */
