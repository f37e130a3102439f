/* Costs of sampling a streamed texture compared with texture(), and the additional cost of
 * feedback. */
#include "scene.h"

#include "../../tools/common/clock.h"

#include <math.h>
#include <stdio.h>

#define MAX_VARIANTS 8u
#define FRAMES 101u
#define LEAST_FRAMES 5u
#define GROUP_SECONDS 5.0 /* limit for software devices, s */

static const char *const scene_names[3] = {"floor", "close_up", "noise"};
static const char *const stage_names[2] = {"compute", "fragment"};

struct variant {
    struct scene_constants constants;
    float probability;
    const char *name;
    struct scene_draw draw;
    struct samples samples;
};

static bool prepare(struct scene *scene, struct variant *variants, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        struct variant *v = &variants[i];
        v->draw = (struct scene_draw){.scene = scene,
                                      .fragment = v->constants.fragment,
                                      .pipeline = scene_pipeline(scene, &v->constants),
                                      .params = scene_params(scene)};
        v->draw.params.probability = v->probability;
        v->draw.warm_up = variants[0].draw.pipeline;
        if (!v->draw.pipeline)
            return false;
        samples_init(&v->samples, FRAMES + LEAST_FRAMES);
    }
    return true;
}

/* Alternates the variants, so that clock changes and other load affect all alike. */
static bool run(struct scene *scene, struct variant *variants, uint32_t count)
{
    uint32_t frames = options.quick ? LEAST_FRAMES : FRAMES;
    double start = clock_seconds();
    for (uint32_t frame = 0; frame < frames; frame++) {
        for (uint32_t i = 0; i < count; i++) {
            struct rig_work work = {.warm_up = scene->rig.bench->wall ? NULL : scene_record_warm_up,
                                    .record = scene_record,
                                    .user = &variants[i].draw,
                                    .samples = {.work = &variants[i].samples}};
            if (frame == 0) /* compiles shaders */
                work.samples.work = NULL;
            if (!rig_frame(&scene->rig, &work))
                return false;
        }
        if (frame + 1 >= LEAST_FRAMES && clock_seconds() - start > GROUP_SECONDS)
            break;
    }
    return rig_finish(&scene->rig);
}

static void finish(struct variant *variants, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        samples_finish(&variants[i].samples);
}

static bool sample_scene(struct scene *scene, bool fragment, uint32_t which, float anisotropy)
{
    const struct bench *bench = scene->rig.bench;
    struct variant variants[2] = {{.constants = {.streamed = false}},
                                  {.constants = {.streamed = true}}};
    for (uint32_t i = 0; i < 2; i++) {
        variants[i].constants.fragment = fragment;
        variants[i].constants.scene = which;
        variants[i].constants.anisotropy = anisotropy;
    }
    bool done = prepare(scene, variants, 2) && run(scene, variants, 2);
    if (done) {
        const char *stage = stage_names[fragment], *kind = anisotropy > 1.0f ? "_aniso8" : "";
        double plain = typical(bench, &variants[0].samples),
               streamed = typical(bench, &variants[1].samples);
        report(bench, plain / 1e3, "us", "sampling.%s.%s%s.plain", stage, scene_names[which], kind);
        report(bench, streamed / 1e3, "us", "sampling.%s.%s%s.streamed", stage, scene_names[which],
               kind);
        report(bench, plain / streamed, "of plain", "sampling.%s.%s%s.speed", stage,
               scene_names[which], kind);
    }
    finish(variants, 2);
    return done;
}

/* Measures the part that all times include: time stamps, and the wait for earlier work. */
static bool measure_nothing(struct scene *scene)
{
    struct samples samples;
    samples_init(&samples, LEAST_FRAMES);
    struct rig_work work = {.samples = {.work = &samples}};
    bool done = true;
    for (uint32_t i = 0; done && i < LEAST_FRAMES; i++)
        done = rig_frame(&scene->rig, &work);
    done = done && rig_finish(&scene->rig);
    if (done)
        report(scene->rig.bench, typical(scene->rig.bench, &samples) / 1e3, "us",
               "sampling.nothing");
    samples_finish(&samples);
    return done;
}

static bool sample_scenes(const struct bench *bench, float anisotropy)
{
    struct scene scene;
    bool done = scene_create(&scene, bench, anisotropy, true);
    for (uint32_t stage = 0; done && stage < 2; stage++)
        for (uint32_t which = 0; done && which < (anisotropy > 1.0f || options.quick ? 1u : 3u);
             which++)
            done = sample_scene(&scene, stage == 1, which, anisotropy);
    if (done && !(anisotropy > 1.0f))
        done = measure_nothing(&scene);
    scene_destroy(&scene);
    return done;
}

bool measure_sampling(const struct bench *bench)
{
    return sample_scenes(bench, 1.0f) && sample_scenes(bench, 8.0f);
}

static bool feed_scene(struct scene *scene, bool fragment, uint32_t which)
{
    const struct bench *bench = scene->rig.bench;
    struct variant variants[7] = {
        {.name = "plain", .constants = {.streamed = false}},
        {.name = "none", .constants = {.streamed = true}},
        {.name = "all", .constants = {.feedback = BENCH_FEEDBACK_ALL}},
        {.name = "quads_16",
         .constants = {.feedback = BENCH_FEEDBACK_QUADS},
         .probability = 1.0f / 16},
        {.name = "quads_64",
         .constants = {.feedback = BENCH_FEEDBACK_QUADS},
         .probability = 1.0f / 64},
        {.name = "blocks_16", .constants = {.feedback = BENCH_FEEDBACK_BLOCKS}},
        {.name = "lattice_64", .constants = {.feedback = BENCH_FEEDBACK_LATTICE}},
    };
    /* Lavapipe takes seconds to compile each. */
    const uint32_t count = options.quick ? 4 : 7;
    for (uint32_t i = 0; i < count; i++) {
        variants[i].constants.fragment = fragment;
        variants[i].constants.streamed = i > 0;
        variants[i].constants.scene = which;
        variants[i].constants.anisotropy = 1.0f;
    }
    bool done = prepare(scene, variants, count) && run(scene, variants, count);
    double plain = done ? typical(bench, &variants[0].samples) : NAN;
    double none = done ? typical(bench, &variants[1].samples) : NAN;
    const char *stage = stage_names[fragment], *name = scene_names[which];
    if (done)
        report(bench, none / 1e3, "us", "feedback.%s.%s.none", stage, name);
    for (uint32_t i = 2; done && i < count; i++) {
        double added = typical(bench, &variants[i].samples) - none;
        report(bench, added / 1e3, "us", "feedback.%s.%s.%s.time", stage, name, variants[i].name);
        report(bench, 100 * added / none, "%", "feedback.%s.%s.%s.added", stage, name,
               variants[i].name);
        report(bench, 100 * added / plain, "% of plain", "feedback.%s.%s.%s.added_to_plain", stage,
               name, variants[i].name);
    }
    finish(variants, count);
    return done;
}

bool measure_feedback(const struct bench *bench)
{
    struct scene scene;
    bool done = scene_create(&scene, bench, 1.0f, true);
    for (uint32_t stage = 0; done && stage < 2; stage++)
        for (uint32_t which = 0; done && which < (options.quick ? 1u : 3u); which++)
            done = feed_scene(&scene, stage == 1, which);
    scene_destroy(&scene);
    return done;
}
