#include "traced.h"

#include "../../samples/demand-pbrt/camera.h"
#include "../../samples/demand-pbrt/lights.h"
#include "../common/clock.h"
#include "../common/text.h"

#include <math.h>
#include <string.h>

#define MOST_VAIN_LAUNCHES 200u /* then the next sample begins, with incomplete pixels */
#define BIAS_STEP 0.05f         /* a larger change of the LOD bias starts a new picture */

/* Fits the whole film into the window. A wider window shows more at the sides, a narrower one more
 * above and below. */
static void fit_window(struct PbrtLaunch *c)
{
    const float wide =
        sqrtf(c->right[0] * c->right[0] + c->right[1] * c->right[1] + c->right[2] * c->right[2]);
    const float high =
        sqrtf(c->down[0] * c->down[0] + c->down[1] * c->down[1] + c->down[2] * c->down[2]);
    const float ratio = (float)c->width / (float)c->height / (wide / high);
    if (!(ratio > 0) || !isfinite(ratio) || fabsf(ratio - 1) < 1e-5f)
        return;
    float *const side = ratio > 1 ? c->right : c->down;
    const float factor = ratio > 1 ? ratio : 1 / ratio;
    for (int i = 0; i < 3; i++) {
        c->corner[i] -= 0.5f * (factor - 1) * side[i];
        side[i] *= factor;
    }
    c->spread *= ratio > 1 ? 1 : factor;
}

struct PbrtLaunch traced_constants(struct traced *t, const struct view_camera *camera)
{
    struct PbrtLaunch c = {.flags = PBRT_LAUNCH_GRAY, .lodBias = (float)t->settings.lod_bias};
    const uint32_t size[2] = {t->film.width, t->film.height};
    float matrix[12];
    pbrt_frame_matrix(&t->pbrt->frame, camera, matrix);
    camera_constants(&t->pbrt->scene, matrix, size, &c);
    fit_window(&c);
    c.flags |= t->settings.freeze_wants ? PBRT_LAUNCH_QUIET : 0u;
    t->options.mode = t->settings.render_mode;
    t->options.bounces = t->settings.depth;
    lights_constants(&t->pbrt->scene, &t->options, t->only_areas, t->emitters.count, &c);
    return c;
}

static void restart(struct traced *t, const struct PbrtLaunch *constants)
{
    t->constants = t->launches.constants = *constants;
    t->restarts = false;
    t->sample = t->vain = 0;
    t->missing = t->film.width * t->film.height;
    t->lod_bias = t->now.lodBias;
    film_clear(&t->film);
    film_begin_sample(&t->film);
}

static bool fit_film(struct traced *t, const struct stage_draw *draw)
{
    if (t->film.width == draw->width && t->film.height == draw->height)
        return true;
    if (!gpu_check(vkQueueWaitIdle(t->gpu->queue), "vkQueueWaitIdle"))
        return false;
    film_destroy(t->gpu, &t->film);
    t->restarts = true;
    t->launches.probes = VK_NULL_HANDLE;
    t->looked = false;
    if (!film_create(t->gpu, draw->width, draw->height, (struct film_share){0}, &t->film) ||
        !traced_view_fit(&t->parts->view, &t->film) ||
        !traced_show_fit(&t->parts->show, &t->film, &t->parts->view))
        return false;
    t->launches.probes = t->parts->view.probes.buffer;
    return true;
}

/* Ends a sample that is complete, or that launches no longer complete: while requests are frozen,
 * for example. */
static void end_launch(struct traced *t, bool progress)
{
    t->missing = t->film.missing_count;
    t->vain = progress ? 0 : t->vain + 1;
    if (t->missing > 0 && t->vain < MOST_VAIN_LAUNCHES && !t->settings.freeze_wants)
        return;
    t->sample++;
    t->vain = 0;
    film_begin_sample(&t->film);
}

static bool trace(struct traced *t)
{
    bool progress = false;
    if (t->sample >= t->settings.most_samples)
        return launches_idle(&t->launches);
    if (!launches_trace(&t->launches, t->sample, &t->ticket, &progress))
        return false;
    t->trace_seconds += t->launches.last_seconds;
    t->rays = t->launches.count;
    traced_note_misses(t);
    end_launch(t, progress);
    return true;
}

/* Launches rays, and waits for all their requests (--deterministic). */
static bool launch_and_wait(struct traced *t)
{
    bool made;
    if (!trace(t))
        return false;
    const SluiceResult result = sluiceWaitDemandTicket(t->loader, t->ticket, UINT64_MAX, NULL);
    if (result == SLUICE_SUCCESS)
        return launches_serve(&t->launches, &made);
    text_say("sluice-view: sluiceWaitDemandTicket: %s", sluiceGetResultName(result));
    return false;
}

/* Launches rays for a window, without waiting for threads. Boxes that do not fit the frame's time
 * stay boxes. */
static bool launch_in_time(struct traced *t)
{
    frame_budget_begin(&t->flight.budget);
    if (!flight_serve(&t->launches, &t->flight))
        return false;
    frame_budget_end_work(&t->flight.budget);
    if (!trace(t))
        return false;
    frame_budget_end(&t->flight.budget);
    return true;
}

static bool launch(struct traced *t)
{
    if (!(t->waits ? launch_and_wait(t) : launch_in_time(t)))
        return false;
    t->before = t->now;
    t->now = (SluiceDemandStatistics){.structSize = sizeof t->now};
    sluiceGetDemandStatistics(t->loader, &t->now);
    t->restarts = t->restarts || fabsf(t->now.lodBias - t->lod_bias) > BIAS_STEP;
    return true;
}

/* Launches rays. The first sample gets as many launches as the frame has time for. */
static bool launch_some(struct traced *t)
{
    const double start = clock_seconds();
    t->trace_seconds = 0;
    do
        if (!launch(t))
            return false;
    while (!t->waits && t->sample == 0 && t->vain == 0 &&
           clock_seconds() - start < TRACED_FRAME_SECONDS);
    return true;
}

static uint32_t sides_of(const struct traced *t, uint32_t picture)
{
    const uint32_t width = t->pictures[picture].texture.width;
    const uint32_t height = t->pictures[picture].texture.height;
    return (width & (width - 1)) != 0 || (height & (height - 1)) != 0;
}

/* Updates the words of textures for view 6. Sizes become known later than textures. */
static bool name_textures(struct traced *t)
{
    for (; t->use_count < t->textures.use_count; t->use_count++) {
        const struct picture_use *use = t->textures.uses[t->use_count];
        const uint32_t index = (uint32_t)use->id;
        uint32_t *words = traced_show_pictures(&t->parts->show, index + 1), picture = 0;
        if (!words)
            return false;
        while (picture < t->picture_count &&
               strcmp(t->pictures[picture].texture.path, use->image->file->path) != 0)
            picture++;
        if (picture < t->picture_count)
            words[index] = (1 + picture) << 1;
        t->most_texture_index = index > t->most_texture_index ? index : t->most_texture_index;
    }
    uint32_t *words = t->parts->show.pictures.mapped;
    for (uint32_t i = 0; i <= t->most_texture_index; i++)
        words[i] = words[i] ? (words[i] & ~1u) | sides_of(t, (words[i] >> 1) - 1) : 0;
    return true;
}

uint32_t traced_picture_of(const struct traced *t, uint32_t texture)
{
    const uint32_t *words = t->parts->show.pictures.mapped;
    return texture <= t->most_texture_index && words[texture] ? (words[texture] >> 1) - 1
                                                              : UINT32_MAX;
}

const struct TracedView *traced_view_at(const struct traced *t, float x, float y)
{
    if (!t->looked || !(x >= 0 && x < 1 && y >= 0 && y < 1))
        return NULL;
    const size_t pixel =
        (size_t)(y * (float)t->film.height) * t->film.width + (size_t)(x * (float)t->film.width);
    const struct TracedView *view = (const struct TracedView *)t->parts->view.views.mapped + pixel;
    return view->texture == PBRT_NONE ? NULL : view;
}

static bool show(struct traced *t, const struct stage_draw *draw)
{
    const struct view_settings *s = draw->settings;
    const struct traced_look look = {.scale = exp2f((float)s->exposure),
                                     .tint = (float)s->tint,
                                     .view = s->view == VIEW_TRUTH ? VIEW_PICTURE : s->view,
                                     .launch = t->rays,
                                     .is_short = t->now.lodBias > 0,
                                     .picture_count = t->most_texture_index + 1};
    return (s->view != VIEW_AGE || traced_show_keep_tiles(&t->parts->show, &t->tiles, t->time)) &&
           traced_show_draw(&t->parts->show, &look);
}

bool traced_record(struct traced *t, const struct stage_draw *draw, VkCommandBuffer commands,
                   struct frames_end *end)
{
    const struct view_settings *s = draw->settings;
    if (!fit_film(t, draw))
        return false;
    t->looks = s->view > VIEW_PICTURE && s->view != VIEW_TRUTH;
    t->rays = 0;
    t->time = draw->time_stamp;
    const struct PbrtLaunch constants = traced_constants(t, &draw->camera);
    const bool moved = memcmp(&constants, &t->constants, sizeof constants) != 0;
    if ((moved || t->restarts) && (!s->pause || !t->parts->show.drawn))
        restart(t, &constants);
    if ((!s->pause || !t->parts->show.drawn) && !launch_some(t))
        return false;
    if (t->looks && !t->looked && !launches_idle(&t->launches)) /* a view was chosen while paused */
        return false;
    traced_tiles_look(&t->tiles, t->loader, &t->now, draw->number, t->time);
    if (!name_textures(t) || !show(t, draw))
        return false;
    if (draw->copy)
        traced_show_copy(&t->parts->show, commands, draw->copy);
    end->views[UI_TEXTURE_PICTURE] = t->parts->show.image.view;
    return true;
}

bool traced_trace_once(struct traced *t, const struct stage_draw *draw)
{
    t->looks = true;
    if (!fit_film(t, draw))
        return false;
    const struct PbrtLaunch constants = traced_constants(t, &draw->camera);
    restart(t, &constants);
    return trace(t) && name_textures(t) && show(t, draw);
}

double traced_complete(const struct traced *t)
{
    const double all = (double)t->film.width * t->film.height;
    if (t->sample > 0 && t->vain == 0 && !t->settings.freeze_wants)
        return 1.0;
    return all > 0 ? 1.0 - t->missing / all : 0.0;
}
