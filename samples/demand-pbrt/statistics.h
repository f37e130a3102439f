/** Counts under the names of the OptiX Toolkit's DemandPbrtScene, to compare with it. */
#ifndef DEMAND_PBRT_STATISTICS_H
#define DEMAND_PBRT_STATISTICS_H

#include "launches.h"

/** Writes a JSON object. What Sluice does not count is null. Says on stderr why it failed. */
bool statistics_write(const struct launches *launches, const char *scene_path, const char *path);

#endif /* DEMAND_PBRT_STATISTICS_H */
