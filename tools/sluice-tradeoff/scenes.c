#include "scenes.h"

#include <stdlib.h>
#include <string.h>

const struct scene *scene_find(const char *name)
{
    const struct scene *const scenes[] = {&scene_gallery, &scene_demand_tracer, &scene_neural,
                                          &scene_view, &scene_trace};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        if (strcmp(scenes[i]->name, name) == 0)
            return scenes[i];
    return NULL;
}

void scene_add_seed(const struct program *program, uint32_t repeat, struct text_list *arguments)
{
    if (!program_has_option(program, "seed"))
        return;
    char *seed = memory_text("%u", repeat + 1);
    text_list_add(arguments, "--seed");
    text_list_add(arguments, seed);
    free(seed);
}
