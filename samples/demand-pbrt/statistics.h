/** Counts under the names of the OptiX Toolkit's DemandPbrtScene, for comparisons. */
#ifndef DEMAND_PBRT_STATISTICS_H
#define DEMAND_PBRT_STATISTICS_H

#include "launches.h"

/** Writes a JSON object. Values that Sluice does not count are null. Reports errors on stderr. */
bool statistics_write(const struct launches *launches, const char *scene_path, const char *path);

#endif /* DEMAND_PBRT_STATISTICS_H */
