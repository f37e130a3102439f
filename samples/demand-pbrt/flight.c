#include "flight.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/text.h"
#include "budget.h"
#include "camera.h"
#include "summary.h"

/* Meshes whose structures are built in one submission. */
#define BATCH 16u
/* Limit of pictures that are opened at a time. */
#define MOST_PICTURES 64u

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        text_say("%s: %s", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static void turn(float v[2], double c, double s)
{
    const double x = v[0], y = v[1];
    v[0] = (float)(c * x - s * y);
    v[1] = (float)(s * x + c * y);
}

/** Orbits around y or z: the axis that is closer to the picture's vertical. */
static void orbit(const struct scene *scene, const struct PbrtLaunch *last, double share,
                  struct PbrtLaunch *constants)
{
    const SluicePbrtBounds *box = &scene->box;
    const double c = cos(share * 6.283185307179586), s = sin(share * 6.283185307179586);
    float *const vectors[] = {constants->eye, constants->corner, constants->right, constants->down,
                              constants->forward};
    float middle[3];
    const int up = fabsf(last->down[1]) > fabsf(last->down[2]) ? 1 : 2;
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5f * (box->least[i] + box->most[i]);
    for (int i = 0; i < 3; i++)
        constants->eye[i] -= middle[i];
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        const int a = up == 2 ? 0 : 2, b = up == 2 ? 1 : 0;
        float v[2] = {vectors[i][a], vectors[i][b]};
        turn(v, c, s);
        vectors[i][a] = v[0];
        vectors[i][b] = v[1];
    }
    for (int i = 0; i < 3; i++)
        constants->eye[i] += middle[i];
}

void flight_place_camera(const struct scene *scene, const struct pbrt_options *o,
                         const uint32_t size[2], double share, struct PbrtLaunch *constants)
{
    const struct PbrtLaunch last = *constants;
    float from[12], to[12], between[12];
    if (share >= 1.0)
        return;
    if (!o->fly_from.given) {
        orbit(scene, &last, share, constants);
        return;
    }
    camera_matrix(scene, &o->fly_from, from);
    camera_matrix(scene, &o->camera, to);
    camera_between(from, to, (float)share, between);
    camera_constants(scene, between, size, constants);
}

/** Waits up to `wait` for pictures that other threads open, and applies the formats of opened
 * pictures. */
static bool look_at_pictures(struct launches *l, uint64_t wait)
{
    struct surfaces *s = l->surfaces;
    while (s->opened_count < s->picture_count) {
        SluiceDemandTicketStatus status = {.structSize = sizeof status};
        SluiceResult result =
            sluiceWaitDemandTicket(l->loader, s->pictures[s->opened_count].ticket, wait, &status);
        if (result == SLUICE_NOT_READY)
            return true;
        if (!check(result, "a picture cannot be waited for"))
            return false;
        s->opened_count++;
    }
    surfaces_finish_pictures(s);
    surfaces_begin(s);
    s->opened_count = 0;
    return true;
}

/** Makes a material without waiting for its pictures. Rays miss its texels until they are open. */
static bool make_surface(struct launches *l, uint32_t surface)
{
    struct surfaces *s = l->surfaces;
    const uint32_t first = s->picture_count;
    if (!surfaces_realize(l->gpu, l->scene, l->textures, s, surface, l->count + 1))
        return false;
    for (uint32_t i = first; i < s->picture_count; i++)
        if (!check(sluicePreloadDemandTexture(l->loader, s->pictures[i].use->id, UINT32_MAX,
                                              &s->pictures[i].ticket),
                   "a picture cannot be loaded"))
            return false;
    return true;
}

static bool serve_surfaces(struct launches *l, struct flight *f)
{
    const struct proxy_requests *r = &l->requests;
    bool fits = true;
    for (uint32_t i = 0; i < r->surface_count && fits; i++) {
        if ((!frame_budget_has_time(&f->budget) && i > 0) ||
            l->surfaces->picture_count >= MOST_PICTURES)
            break;
        if (!make_surface(l, r->surfaces[i]) ||
            !budget_make_surface_room(l->world, l->surfaces, l->count + 1, &fits))
            return false;
    }
    return true;
}

/* Nodes whose files or builds are not ready stay boxes, and rays request them again. */
static bool serve_nodes(struct launches *l, struct flight *f)
{
    const struct proxy_requests *r = &l->requests;
    uint64_t count = 0;
    for (uint32_t i = 0; i < r->node_count; i++) {
        bool ready;
        if (!frame_budget_has_time(&f->budget) && count + l->world->meshes.waiting.count > 0)
            break;
        if (!world_fetch(l->world, r->nodes[i], &ready))
            return false;
        if (!ready)
            continue;
        if (!proxies_take_node(l->proxies, r, i) || !world_resolve(l->world, r->nodes[i]))
            return false;
        count++;
        if (l->world->to_build_count >= BATCH && !world_build_meshes(l->world, l->count + 1))
            return false;
    }
    f->resolved += count;
    f->most_resolved = count > f->most_resolved ? count : f->most_resolved;
    return world_build_meshes(l->world, l->count + 1) && world_begin_builds(l->world);
}

bool flight_serve(struct launches *l, struct flight *f)
{
    return !l->proxies ||
           (look_at_pictures(l, 0) && world_continue_builds(l->world, l->count + 1, false) &&
            proxies_list(l->proxies, l->constants.eye, &l->requests) && serve_surfaces(l, f) &&
            serve_nodes(l, f));
}

/* Launches read list 0, with all pixels, and write list 1. */
static void begin_frame(struct film *film)
{
    film->list_index = 0;
    film->missing_count = film->width * film->height;
}

static void count(struct flight_phase *phase, double seconds)
{
    phase->sum += seconds;
    phase->most = seconds > phase->most ? seconds : phase->most;
}

static bool fly_frame(struct launches *l, struct flight *f, uint32_t frame)
{
    SluiceDemandTicket ticket;
    bool progress;
    frame_budget_begin(&f->budget);
    if (!flight_serve(l, f))
        return false;
    count(&f->work, frame_budget_end_work(&f->budget));
    const double top_before = l->world->top_seconds;
    begin_frame(l->film);
    if (!launches_trace(l, 0, &ticket, &progress))
        return false;
    count(&f->top_level, l->world->top_seconds - top_before);
    count(&f->launch, l->last_seconds);
    f->missing += l->film->missing_count;
    f->seconds[frame] = frame_budget_end(&f->budget);
    return true;
}

static bool fly(struct launches *l, struct flight *f)
{
    const struct PbrtLaunch last = l->constants;
    const uint32_t size[2] = {l->film->width, l->film->height};
    film_begin_sample(l->film);
    for (uint32_t i = 0; i < f->frame_count; i++) {
        l->constants = last;
        flight_place_camera(l->scene, l->options, size, (i + 1.0) / f->frame_count, &l->constants);
        if (!fly_frame(l, f, i))
            return false;
        if (l->options->sequence || l->options->contact_sheet)
            film_clear(l->film);
    }
    return look_at_pictures(l, UINT64_MAX) && world_continue_builds(l->world, l->count + 1, true);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

bool flight_run(struct launches *l, struct flight *f)
{
    f->seconds = calloc(f->frame_count + 1u, sizeof *f->seconds);
    if (!f->seconds) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    if (!fly(l, f))
        return false;
    qsort(f->seconds, f->frame_count, sizeof *f->seconds, compare);
    film_clear(l->film);
    return true;
}

void flight_finish(struct flight *f)
{
    free(f->seconds);
    f->seconds = NULL;
}

/** The value that a share of the frames does not exceed, in ms. */
static double percentile(const struct flight *f, double share)
{
    const uint32_t rank = (uint32_t)ceil(share * f->frame_count);
    return 1e3 * f->seconds[rank > 0 ? rank - 1 : 0];
}

void flight_print(const struct flight *f, bool json)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < f->frame_count; i++)
        sum += f->seconds[i];
    const struct figure figures[] = {
        {"frames", "", f->frame_count},
        {"frame_mean", "ms", 1e3 * sum / f->frame_count},
        {"frame_median", "ms", percentile(f, 0.5)},
        {"frame_p99", "ms", percentile(f, 0.99)},
        {"frame_longest", "ms", percentile(f, 1.0)},
        {"frame_pixels_missing", "mean", f->missing / f->frame_count},
        {"frame_boxes_resolved", "mean", (double)f->resolved / f->frame_count},
        {"frame_boxes_resolved_most", "", (double)f->most_resolved},
        {"frame_work_mean", "ms", 1e3 * f->work.sum / f->frame_count},
        {"frame_work_longest", "ms", 1e3 * f->work.most},
        {"frame_top_level_mean", "ms", 1e3 * f->top_level.sum / f->frame_count},
        {"frame_top_level_longest", "ms", 1e3 * f->top_level.most},
        {"frame_launch_mean", "ms", 1e3 * f->launch.sum / f->frame_count},
        {"frame_launch_longest", "ms", 1e3 * f->launch.most},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        summary_print_figure(&figures[i], json);
}
