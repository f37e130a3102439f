#include "scenes.h"

#include <string.h>

const struct scene *scene_find(const char *name)
{
    const struct scene *const scenes[] = {&scene_gallery, &scene_demand_tracer, &scene_trace};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        if (strcmp(scenes[i]->name, name) == 0)
            return scenes[i];
    return NULL;
}
