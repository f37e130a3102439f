/** Lights of a scene, for shaders. */
#ifndef DEMAND_PBRT_LIGHTS_H
#define DEMAND_PBRT_LIGHTS_H

#include "options.h"
#include "pbrt_shared.h"
#include "scene.h"
#include "table.h"
#include "textures.h"

/** Fills a table of struct PbrtLight, in the order of the scene. Adds the pictures of skies without
 * opening them. `*only_areas`: all lights are shapes. */
bool lights_create(const struct gpu *gpu, const struct scene *scene, struct textures *textures,
                   struct table *table, bool *only_areas);
/** Sets the members for the choice and the number of lights. */
void lights_constants(const struct scene *scene, const struct pbrt_options *options,
                      bool only_areas, uint32_t emitter_count, struct PbrtLaunch *constants);

#endif /* DEMAND_PBRT_LIGHTS_H */
