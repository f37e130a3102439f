#include "gltf_animation.h"

#include "gltf_accessor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const cJSON *member(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

/* Returns a checked index: whole, and below the count. */
static uint32_t index_of(const cJSON *object, const char *name)
{
    const cJSON *item = member(object, name);
    return cJSON_IsNumber(item) ? (uint32_t)item->valuedouble : GLTF_NONE;
}

static int find_word(const char *const *words, int count, const char *word)
{
    int i = 0;
    while (i < count && (!word || strcmp(words[i], word) != 0))
        i++;
    return i;
}

enum gltf_track_path gltf_track_path_of(const char *name)
{
    static const char *const words[] = {"translation", "rotation", "scale"};
    return (enum gltf_track_path)find_word(words, TRACK_PATH_COUNT, name);
}

enum gltf_interpolation gltf_interpolation_of(const char *name)
{
    static const char *const words[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    return name ? (enum gltf_interpolation)find_word(words, TRACK_INTERPOLATION_COUNT, name)
                : TRACK_LINEAR;
}

static bool is_in(const struct gltf_chain *chain, uint32_t node)
{
    for (uint32_t i = 0; i < chain->count; i++)
        if (chain->nodes[i] == node)
            return true;
    return false;
}

static const struct gltf_track *find(const struct gltf_tracks *tracks, uint32_t node,
                                     enum gltf_track_path path)
{
    for (uint32_t i = 0; tracks && i < tracks->count; i++)
        if (tracks->items[i].node == node && tracks->items[i].path == path)
            return &tracks->items[i];
    return NULL;
}

static bool read_sampler(struct gltf_file *file, const cJSON *sampler, struct gltf_track *track)
{
    struct gltf_accessor times, values;
    const uint32_t input = index_of(sampler, "input"), output = index_of(sampler, "output");
    if (!gltf_read_accessor(file, input, &times) || !gltf_read_accessor(file, output, &values))
        return false;
    track->interpolation =
        gltf_interpolation_of(cJSON_GetStringValue(member(sampler, "interpolation")));
    track->count = (uint32_t)times.count;
    track->components = values.components;
    track->times = gltf_read_numbers(file, input, &times);
    track->values = gltf_read_numbers(file, output, &values);
    return track->times && track->values;
}

bool gltf_read_tracks(struct gltf_file *file, uint32_t animation, const struct gltf_chain *chain,
                      struct gltf_tracks *tracks)
{
    const cJSON *item = file->lists[GLTF_ANIMATIONS].items[animation];
    const cJSON *samplers = member(item, "samplers"), *channels = member(item, "channels");
    *tracks = (struct gltf_tracks){0};
    for (const cJSON *c = channels ? channels->child : NULL; c; c = c->next) {
        const cJSON *target = member(c, "target");
        struct gltf_track track = {
            .node = index_of(target, "node"),
            .path = gltf_track_path_of(cJSON_GetStringValue(member(target, "path")))};
        if (track.path == TRACK_PATH_COUNT || !is_in(chain, track.node) ||
            find(tracks, track.node, track.path))
            continue;
        struct gltf_track *items =
            realloc(tracks->items, (tracks->count + 1u) * sizeof *tracks->items);
        if (!items)
            return false;
        tracks->items = items;
        const bool read =
            read_sampler(file, cJSON_GetArrayItem(samplers, (int)index_of(c, "sampler")), &track);
        tracks->items[tracks->count++] = track; /* owns its data even if reading failed */
        if (!read)
            return false;
    }
    return true;
}

void gltf_tracks_finish(struct gltf_tracks *tracks)
{
    for (uint32_t i = 0; i < tracks->count; i++) {
        free(tracks->items[i].times);
        free(tracks->items[i].values);
    }
    free(tracks->items);
    *tracks = (struct gltf_tracks){0};
}

/* Returns the last key at or before a time; `before`: the last key before it. At least 0. */
static uint32_t find_key(const struct gltf_track *track, double seconds, bool before)
{
    uint32_t low = 0, high = track->count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (track->times[middle] < seconds || (!before && track->times[middle] == seconds))
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void normalize(double q[4])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] = length > 0 ? q[i] / length : i == 3;
}

/* Interpolates quaternions along the shorter arc. */
static void slerp(const double a[4], const double b[4], double part, double out[4])
{
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const double sign = dot < 0 ? -1 : 1;
    dot = fabs(dot);
    double first = 1 - part, second = part;
    if (dot < 1 - 1e-12) {
        const double angle = acos(dot);
        first = sin((1 - part) * angle) / sin(angle);
        second = sin(part * angle) / sin(angle);
    }
    for (int i = 0; i < 4; i++)
        out[i] = first * a[i] + sign * second * b[i];
}

/* Cubic Hermite spline of glTF 2.0, appendix C. */
static void cubic(const double *a, const double *b, uint32_t n, double time, double part,
                  double *out)
{
    const double s = part, s2 = s * s, s3 = s2 * s;
    for (uint32_t i = 0; i < n; i++)
        out[i] = (2 * s3 - 3 * s2 + 1) * a[n + i] + time * (s3 - 2 * s2 + s) * a[2 * n + i] +
                 (3 * s2 - 2 * s3) * b[n + i] + time * (s3 - s2) * b[i];
}

void gltf_track_at(const struct gltf_track *track, double seconds, bool before, double value[4])
{
    const uint32_t n = track->components, key = find_key(track, seconds, before);
    const uint32_t keys = track->interpolation == TRACK_CUBIC ? 3 : 1;
    const double *a = track->values + (size_t)key * keys * n, *b = a + (size_t)keys * n;
    const double begin = track->times[key];
    const bool stands = key + 1 == track->count || seconds <= begin;
    const double time = stands ? 1 : track->times[key + 1] - begin;
    const double part = stands ? 0 : (seconds - begin) / time;
    memcpy(value, a + (keys == 3 ? n : 0), n * sizeof *value);
    if (track->path == TRACK_ROTATION)
        normalize(value);
    if (stands || track->interpolation == TRACK_STEP)
        return;
    if (track->interpolation == TRACK_CUBIC) {
        cubic(a, b, n, time, part, value);
    } else if (track->path == TRACK_ROTATION) {
        double next[4], from[4];
        memcpy(next, b, sizeof next);
        memcpy(from, value, sizeof from);
        normalize(next);
        slerp(from, next, part, value);
    } else {
        for (uint32_t i = 0; i < n; i++)
            value[i] = a[i] + (b[i] - a[i]) * part;
    }
    if (track->path == TRACK_ROTATION)
        normalize(value);
}

static void write_trs(const double t[3], const double q[4], const double s[3], double m[16])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double turn[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
        2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
        2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
    for (int c = 0; c < 3; c++) {
        for (int r = 0; r < 3; r++)
            m[4 * c + r] = turn[3 * c + r] * s[c];
        m[4 * c + 3] = 0;
    }
    memcpy(m + 12, t, 3 * sizeof *t);
    m[15] = 1;
}

/* Reads checked numbers of a node's property. */
static bool get(const cJSON *node, const char *name, int count, double *values)
{
    const cJSON *item = member(node, name);
    item = item ? item->child : NULL;
    const bool has = item != NULL;
    for (int i = 0; item && i < count; i++, item = item->next)
        values[i] = item->valuedouble;
    return has;
}

static void local_matrix(const struct gltf_file *file, uint32_t index,
                         const struct gltf_tracks *tracks, double seconds, bool before,
                         double m[16])
{
    static const char *const names[] = {"translation", "rotation", "scale"};
    static const int counts[] = {3, 4, 3};
    double values[TRACK_PATH_COUNT][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1, 0}};
    const cJSON *node = file->lists[GLTF_NODES].items[index];
    bool moves = false;
    for (int path = 0; path < TRACK_PATH_COUNT; path++) {
        const struct gltf_track *track = find(tracks, index, (enum gltf_track_path)path);
        get(node, names[path], counts[path], values[path]);
        if (path == TRACK_ROTATION)
            normalize(values[path]);
        if (track)
            gltf_track_at(track, seconds, before, values[path]);
        moves |= track != NULL;
    }
    if (moves || !get(node, "matrix", 16, m)) /* animated nodes have no matrix */
        write_trs(values[TRACK_TRANSLATION], values[TRACK_ROTATION], values[TRACK_SCALE], m);
}

void gltf_chain_matrix(const struct gltf_file *file, const struct gltf_chain *chain,
                       const struct gltf_tracks *tracks, double seconds, bool before,
                       double matrix[16])
{
    double local[16], outer[16];
    for (int i = 0; i < 16; i++)
        matrix[i] = i % 5 == 0;
    for (uint32_t n = 0; n < chain->count; n++) {
        local_matrix(file, chain->nodes[n], tracks, seconds, before, local);
        memcpy(outer, matrix, sizeof outer);
        for (int c = 0; c < 4; c++)
            for (int r = 0; r < 4; r++) {
                double sum = 0;
                for (int k = 0; k < 4; k++)
                    sum += outer[4 * k + r] * local[4 * c + k];
                matrix[4 * c + r] = sum;
            }
    }
}
