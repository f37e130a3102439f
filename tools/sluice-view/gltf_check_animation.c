#include "gltf_accessor.h"
#include "gltf_animation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WHERE_SIZE 96
#define MOST_NUMBERS (1u << 28) /* in all animations; shared accessors count for each sampler */

static const cJSON *member(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static bool spend(struct gltf_file *file, const char *where, uint64_t count)
{
    file->animated_count += count;
    return file->animated_count <= MOST_NUMBERS ||
           gltf_fail(file, "%s: animations have more than %u numbers", where, MOST_NUMBERS);
}

static bool check_times(struct gltf_file *file, const char *where, uint32_t input,
                        const struct gltf_accessor *a)
{
    double *times = gltf_read_numbers(file, input, a);
    bool good = times != NULL || gltf_fail(file, "out of memory");
    for (uint64_t i = 0; good && i < a->count; i++)
        if (!(times[i] >= 0 && times[i] <= 1e6) || (i > 0 && !(times[i] > times[i - 1])))
            good = gltf_fail(file, "%s: time %llu is %g; times grow from 0 s, to 1000000 s at most",
                             where, (unsigned long long)i, times[i]);
    free(times);
    return good;
}

static bool check_sampler(struct gltf_file *file, const cJSON *sampler, const char *where)
{
    struct gltf_accessor times, values;
    uint32_t input, output;
    if (!gltf_get_index(file, sampler, where, "input", GLTF_ACCESSORS, &input) ||
        !gltf_get_index(file, sampler, where, "output", GLTF_ACCESSORS, &output))
        return false;
    if (input == GLTF_NONE || output == GLTF_NONE || !gltf_read_accessor(file, input, &times) ||
        !gltf_read_accessor(file, output, &values))
        return gltf_fail(file, "%s lacks input or output", where);
    if (times.components != 1 || times.component_type != 5126)
        return gltf_fail(file, "%s.input: accessors[%u] is no list of floats", where, input);
    if (times.count > GLTF_MOST_KEYS)
        return gltf_fail(file, "%s has %llu keys; %u can be", where,
                         (unsigned long long)times.count, GLTF_MOST_KEYS);
    if (member(sampler, "interpolation") &&
        (!cJSON_IsString(member(sampler, "interpolation")) ||
         gltf_interpolation_of(cJSON_GetStringValue(member(sampler, "interpolation"))) ==
             TRACK_INTERPOLATION_COUNT))
        return gltf_fail(file, "%s.interpolation is not LINEAR, STEP or CUBICSPLINE", where);
    return spend(file, where, times.count) && check_times(file, where, input, &times);
}

/* Checks that a sampler has a whole number of values per key, in the format of the property. */
static bool check_values(struct gltf_file *file, const cJSON *sampler, const char *where,
                         enum gltf_track_path path)
{
    struct gltf_accessor times, values;
    uint32_t input, output;
    const enum gltf_interpolation interpolation =
        gltf_interpolation_of(cJSON_GetStringValue(member(sampler, "interpolation")));
    if (!gltf_get_index(file, sampler, where, "input", GLTF_ACCESSORS, &input) ||
        !gltf_get_index(file, sampler, where, "output", GLTF_ACCESSORS, &output) ||
        !gltf_read_accessor(file, input, &times) || !gltf_read_accessor(file, output, &values))
        return false;
    const uint64_t wanted = times.count * (interpolation == TRACK_CUBIC ? 3 : 1);
    const bool is_rotation = path == TRACK_ROTATION;
    const bool fits = values.components == (is_rotation ? 4u : 3u) && values.count == wanted &&
                      (values.component_type == 5126 ||
                       (is_rotation && values.normalized && values.component_type <= 5123));
    return fits || gltf_fail(file,
                             "%s: accessors[%u] has %llu elements of %u components; %llu of %d "
                             "floats are needed",
                             where, output, (unsigned long long)values.count, values.components,
                             (unsigned long long)wanted, is_rotation ? 4 : 3);
}

static bool check_finite(struct gltf_file *file, const cJSON *sampler, const char *where)
{
    struct gltf_accessor values;
    uint32_t output;
    if (!gltf_get_index(file, sampler, where, "output", GLTF_ACCESSORS, &output) ||
        !gltf_read_accessor(file, output, &values) ||
        !spend(file, where, values.count * values.components))
        return false;
    double *numbers = gltf_read_numbers(file, output, &values);
    bool good = numbers != NULL || gltf_fail(file, "out of memory");
    for (uint64_t i = 0; good && i < values.count * values.components; i++)
        if (!(fabs(numbers[i]) <= 1e30))
            good = gltf_fail(file, "%s: accessors[%u] has no number that can be used at %llu",
                             where, output, (unsigned long long)i);
    free(numbers);
    return good;
}

/* Checks a channel. Ignores paths of extensions and weights of meshes. */
static bool check_channel(struct gltf_file *file, const cJSON *channel, const char *where,
                          cJSON *const *samplers, uint64_t count)
{
    const cJSON *target = member(channel, "target");
    const char *path = cJSON_GetStringValue(member(target, "path"));
    const enum gltf_track_path kind = gltf_track_path_of(path);
    uint64_t sampler = UINT64_MAX;
    uint32_t node;
    if (!gltf_get_whole(file, channel, where, "sampler", 0, GLTF_MAX_ITEMS, &sampler) ||
        !gltf_get_index(file, target, where, "node", GLTF_NODES, &node))
        return false;
    if (sampler >= count || !path)
        return gltf_fail(file, "%s has no sampler or path", where);
    return kind == TRACK_PATH_COUNT || (check_values(file, samplers[sampler], where, kind) &&
                                        check_finite(file, samplers[sampler], where));
}

static bool check_all(struct gltf_file *file, uint32_t index, cJSON **list, uint64_t most)
{
    char where[WHERE_SIZE];
    const cJSON *animation = file->lists[GLTF_ANIMATIONS].items[index];
    const cJSON *samplers = member(animation, "samplers");
    const cJSON *channels = member(animation, "channels");
    uint64_t count = 0, channel = 0;
    for (cJSON *s = samplers ? samplers->child : NULL; s && count < most; s = s->next) {
        snprintf(where, sizeof where, "animations[%u].samplers[%llu]", index,
                 (unsigned long long)count);
        list[count++] = s;
        if (!check_sampler(file, s, where))
            return false;
    }
    for (const cJSON *c = channels ? channels->child : NULL; c; c = c->next) {
        snprintf(where, sizeof where, "animations[%u].channels[%llu]", index,
                 (unsigned long long)channel++);
        if (!check_channel(file, c, where, list, count))
            return false;
    }
    return true;
}

bool gltf_check_animation(struct gltf_file *file, uint32_t index)
{
    const cJSON *samplers = member(file->lists[GLTF_ANIMATIONS].items[index], "samplers");
    const cJSON *channels = member(file->lists[GLTF_ANIMATIONS].items[index], "channels");
    if ((samplers && !cJSON_IsArray(samplers)) || (channels && !cJSON_IsArray(channels)))
        return gltf_fail(file, "animations[%u]: samplers or channels are no array", index);
    const int count = samplers ? cJSON_GetArraySize(samplers) : 0;
    if (count < 0 || (uint32_t)count > GLTF_MAX_ITEMS)
        return gltf_fail(file, "animations[%u] has %d samplers; %u can be", index, count,
                         GLTF_MAX_ITEMS);
    cJSON **list = malloc(((size_t)count + 1) * sizeof *list);
    const bool good =
        list ? check_all(file, index, list, (uint64_t)count) : gltf_fail(file, "out of memory");
    free(list);
    return good;
}
