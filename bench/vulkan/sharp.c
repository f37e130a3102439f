/* Frames from the first sight of a texture until its visible part is sharp. The source has no
 * latency. */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MAX_FRAMES 128u

struct sharpness {
    uint32_t seen, blurred; ///< regions
};

static struct sharpness count_regions(const struct rig *rig)
{
    struct sharpness s = {0, 0};
    const uint32_t *regions = rig->outputs.mapped;
    for (uint32_t i = 0; i < rig->map_width * rig->map_height; i++) {
        s.seen += regions[i] > 0;
        s.blurred += regions[i] > 1;
    }
    return s;
}

/* Draws frames. Each frame's reads and bindings end before the next frame begins. */
static bool watch(struct scene *scene, struct scene_draw *draw, const char *name)
{
    const struct bench *bench = scene->rig.bench;
    struct rig_work work = {.record = scene_record, .user = draw};
    double frames_99 = NAN, frames_all = NAN;
    struct sharpness s = {0, 0};
    uint32_t blurred_first = 0;
    uint64_t before = rig_statistics(&scene->rig).tilesMapped;
    for (uint32_t i = 0; i < MAX_FRAMES && isnan(frames_all); i++) {
        memset(scene->rig.outputs.mapped, 0, (size_t)scene->rig.outputs.size);
        if (!rig_frame(&scene->rig, &work) || !rig_settle(&scene->rig))
            return false;
        s = count_regions(&scene->rig);
        if (i == 0)
            blurred_first = s.blurred;
        if (isnan(frames_99) && s.blurred * 100.0 <= blurred_first)
            frames_99 = i;
        if (s.blurred == 0)
            frames_all = i;
    }
    report(bench, s.seen, "regions", "sharp.%s.regions_seen", name);
    report(bench, blurred_first, "regions", "sharp.%s.regions_blurred_first", name);
    report(bench, (double)(rig_statistics(&scene->rig).tilesMapped - before), "tiles",
           "sharp.%s.tiles", name);
    report(bench, isnan(frames_99) ? MAX_FRAMES : frames_99, "frames", "sharp.%s.frames_99", name);
    report(bench, isnan(frames_all) ? MAX_FRAMES : frames_all, "frames", "sharp.%s.frames", name);
    return true;
}

static bool watch_cold(const struct bench *bench, uint32_t feedback, float probability,
                       const char *name)
{
    struct scene scene;
    struct scene_constants constants = {.counting = true, .feedback = feedback, .anisotropy = 1.0f};
    bool done = scene_create(&scene, bench, 1.0f, false) && rig_load(&scene.rig, NULL);
    if (done) {
        struct scene_draw draw = {.scene = &scene,
                                  .pipeline = scene_pipeline(&scene, &constants),
                                  .params = scene_params(&scene)};
        draw.params.probability = probability;
        done = draw.pipeline && watch(&scene, &draw, name);
    }
    scene_destroy(&scene);
    return done;
}

bool measure_sharp(const struct bench *bench)
{
    return watch_cold(bench, BENCH_FEEDBACK_ALL, 1.0f, "all") &&
           watch_cold(bench, BENCH_FEEDBACK_QUADS, 1.0f / 16, "quads_16") &&
           (options.quick || watch_cold(bench, BENCH_FEEDBACK_BLOCKS, 1.0f / 16, "blocks_16"));
}
