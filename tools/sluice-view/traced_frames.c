#include "traced.h"

#include "../../samples/demand-pbrt/camera.h"
#include "../../samples/demand-pbrt/lights.h"
#include "../common/clock.h"
#include "../common/text.h"

#include <math.h>
#include <string.h>

#define MOST_VAIN_LAUNCHES 200u /* then the next sample begins: some pixels stay incomplete */
#define BIAS_STEP 0.05f         /* a blurrier or sharper picture is gathered anew */

/* The whole film is seen: a wider window sees more at the sides, a narrower one above and below. */
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
    struct PbrtLaunch c = {.flags = PBRT_LAUNCH_GRAY};
    const uint32_t size[2] = {t->film.width, t->film.height};
    float matrix[12];
    pbrt_frame_matrix(&t->pbrt->frame, camera, matrix);
    camera_constants(&t->pbrt->scene, matrix, size, &c);
    fit_window(&c);
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
    return film_create(t->gpu, draw->width, draw->height, (struct film_share){0}, &t->film) &&
           traced_show_fit(&t->show, &t->film);
}

/* The sample is complete, or nothing completes it. */
static void end_launch(struct traced *t, bool progress)
{
    t->missing = t->film.missing_count;
    t->vain = progress ? 0 : t->vain + 1;
    if (t->missing > 0 && t->vain < MOST_VAIN_LAUNCHES)
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
    traced_note_misses(t);
    end_launch(t, progress);
    return true;
}

/* Frames that wait: all that the launch asked for is made. */
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

/* Windows: work of threads is not waited for, and boxes that there is no time for stay. */
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

/* The first sample takes as many launches as there is time for. */
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

bool traced_record(struct traced *t, const struct stage_draw *draw, struct frames_end *end)
{
    const struct view_settings *s = draw->settings;
    if (!fit_film(t, draw))
        return false;
    const struct PbrtLaunch constants = traced_constants(t, &draw->camera);
    const bool moved = memcmp(&constants, &t->constants, sizeof constants) != 0;
    if ((moved || t->restarts) && (!s->pause || !t->show.drawn))
        restart(t, &constants);
    if ((!s->pause || !t->show.drawn) && !launch_some(t))
        return false;
    if (!traced_show_draw(&t->show, exp2f((float)s->exposure),
                          s->view == VIEW_MISSING ? (float)s->tint : 0.0f))
        return false;
    end->views[UI_TEXTURE_PICTURE] = t->show.image.view;
    return true;
}

double traced_complete(const struct traced *t)
{
    const double all = (double)t->film.width * t->film.height;
    if (t->sample > 0 && t->vain == 0)
        return 1.0;
    return all > 0 ? 1.0 - t->missing / all : 0.0;
}
