#include "golden_demand.h"

#include "demand_app.h"

#include "replay/demand_recorder.h"
#include "support/test.h"

#include <stdio.h>

/* Class 0: tiles, with places. Class 1: values. Class 2: byte pages, with places. Reads end when
 * end_reads is called. */
struct scene {
    struct slc_demand_residency *residency;
    struct fake_memory memory, byte_memory;
    uint64_t launch;
    uint32_t loading[64];
    uint32_t loading_count;
};

static void limit_tiles(struct scene *scene, uint64_t limit)
{
    const struct slc_page_memory memory = fake_page_memory(&scene->memory);
    CHECK_OK(slc_residency_set_class(scene->residency, 0, limit, &memory));
}

static void show(struct scene *scene)
{
    struct slc_page_change changes[64];
    struct slc_page_evicted evicted[64];
    slc_residency_prepare(scene->residency, scene->launch + 1);
    slc_residency_take_changes(scene->residency, changes, 64);
    slc_residency_take_evicted(scene->residency, evicted, 64);
}

static void begin(struct scene *scene)
{
    show(scene);
    slc_residency_begin(scene->residency, ++scene->launch);
}

static void use(struct scene *scene, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        slc_residency_use(scene->residency, first + i);
}

static void request(struct scene *scene, const struct slc_page_request *request)
{
    SluiceResult result;
    if (slc_residency_request(scene->residency, request, &result) == SLC_REQUEST_LOAD)
        scene->loading[scene->loading_count++] = request->page;
    CHECK_OK(result);
}

static void request_tiles(struct scene *scene, uint32_t first, uint32_t count, uint8_t rank)
{
    for (uint32_t i = 0; i < count; i++)
        request(scene, &(struct slc_page_request){.page = first + i, .rank = rank});
}

static void end_reads(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->loading_count; i++)
        slc_residency_loaded(scene->residency, scene->loading[i], 7000 + scene->loading[i]);
    scene->loading_count = 0;
}

static void settle(struct scene *scene, uint64_t missing)
{
    slc_residency_settle(scene->residency, missing);
}

/* Opens a texture, then loads its mip tail and two levels of tiles. */
static void play_first_launches(struct scene *scene)
{
    begin(scene);
    request(scene, &(struct slc_page_request){.page = 1, .class_index = 1, .pinned = 1});
    settle(scene, 1);
    end_reads(scene);
    begin(scene);
    use(scene, 1, 1);
    request(scene, &(struct slc_page_request){.page = 40, .pinned = 1});
    request_tiles(scene, 36, 4, 2);
    settle(scene, 5);
    end_reads(scene);
    begin(scene);
    use(scene, 1, 1);
    use(scene, 36, 5);
    request_tiles(scene, 20, 6, 4);
    settle(scene, 6);
    end_reads(scene);
    begin(scene);
    use(scene, 20, 6);
    settle(scene, 0);
    show(scene);
}

/* With six places, the finest of the least recently used pages are evicted first, and loaded again
 * later. */
static void play_eviction(struct scene *scene)
{
    limit_tiles(scene, 6);
    begin(scene);
    request_tiles(scene, 10, 2, 1);
    request_tiles(scene, 30, 4, 3);
    settle(scene, 6);
    end_reads(scene);
    begin(scene);
    use(scene, 30, 4);
    use(scene, 10, 2);
    settle(scene, 0);
    begin(scene);
    use(scene, 10, 1);
    request_tiles(scene, 50, 3, 3);
    settle(scene, 3);
    end_reads(scene);
    begin(scene);
    use(scene, 50, 3);
    settle(scene, 0);
    limit_tiles(scene, 7);
    begin(scene);
    request_tiles(scene, 30, 4, 3);
    settle(scene, 4);
    end_reads(scene);
    show(scene);
}

/* More tiles than places: the bias rises, and falls when the view requires fewer. */
static void play_bias(struct scene *scene)
{
    limit_tiles(scene, 8);
    for (uint32_t i = 0; i < 12; i++) {
        begin(scene);
        uint32_t bias = (uint32_t)(4 * slc_residency_lod_bias(scene->residency));
        uint32_t wanted = i < 6 ? 24 >> (bias + 1) / 2 : 3;
        use(scene, 100, wanted);
        request_tiles(scene, 100, wanted, 3);
        settle(scene, wanted);
        end_reads(scene);
    }
    show(scene);
}

/* More tiles than places without a bias: tiles without a place are refused, and may be requested
 * again. */
static void play_refusals(struct scene *scene)
{
    limit_tiles(scene, 8);
    for (uint32_t i = 0; i < 6; i++) {
        begin(scene);
        use(scene, 100, i < 3 ? 8 : 1);
        request_tiles(scene, 100, i < 3 ? 12 : 1, 3);
        settle(scene, i < 3 ? 12 : 1);
        end_reads(scene);
    }
    show(scene);
}

/* Two formats in chunks of three places: a chunk must be free before it holds the other format. */
static void play_formats(struct scene *scene)
{
    fake_memory_init(&scene->memory, 6, 3);
    limit_tiles(scene, 6);
    begin(scene);
    for (uint32_t i = 0; i < 6; i++)
        request(scene, &(struct slc_page_request){.page = 60 + i, .kind = 10});
    settle(scene, 6);
    end_reads(scene);
    for (uint32_t i = 0; i < 4; i++) {
        begin(scene);
        for (uint32_t k = 0; k < 2; k++)
            request(scene, &(struct slc_page_request){.page = 80 + 2 * i + k, .kind = 20});
        settle(scene, 2);
        end_reads(scene);
    }
    show(scene);
}

/* Reads fail, are refused and retried. A page is forgotten while it is read. */
static void play_failures(struct scene *scene)
{
    begin(scene);
    request_tiles(scene, 10, 4, 2);
    settle(scene, 4);
    slc_residency_failed(scene->residency, 10, false);
    slc_residency_failed(scene->residency, 11, true);
    slc_residency_forget(scene->residency, 12, 1);
    scene->loading[0] = 12;
    scene->loading[1] = 13;
    scene->loading_count = 2;
    end_reads(scene);
    begin(scene);
    request_tiles(scene, 10, 4, 2);
    settle(scene, 4);
    slc_residency_retry(scene->residency, 11);
    slc_residency_retry(scene->residency, 13);
    show(scene);
    slc_residency_abandon(scene->residency, scene->launch + 1);
    begin(scene);
    request_tiles(scene, 10, 4, 2);
    settle(scene, 4);
    end_reads(scene);
    show(scene);
}

/* Values without places, four at a time. Each eviction is reported. */
static void play_resources(struct scene *scene)
{
    CHECK_OK(slc_residency_set_class(scene->residency, 1, 4, NULL));
    for (uint32_t i = 0; i < 4; i++) {
        begin(scene);
        for (uint32_t k = 0; k < 3; k++)
            request(scene, &(struct slc_page_request){
                               .page = 200 + 2 * i + k, .class_index = 1, .rank = 1});
        settle(scene, 3);
        end_reads(scene);
    }
    CHECK_OK(slc_residency_set_class(scene->residency, 1, 2, NULL));
    begin(scene);
    settle(scene, 0);
    slc_residency_forget(scene->residency, 200, 20);
    show(scene);
}

static void request_bytes(struct scene *scene, uint32_t first, uint32_t count, uint32_t kind)
{
    for (uint32_t i = 0; i < count; i++)
        request(scene, &(struct slc_page_request){
                           .page = first + i, .class_index = 2, .rank = 4, .kind = kind});
}

/* Byte pages of two sizes in slabs of four places. A whole slab of one size is evicted for a page
 * of the other size. One page is restored without a read. */
static void play_bytes(struct scene *scene)
{
    const struct slc_page_memory memory = fake_page_memory(&scene->byte_memory);
    fake_memory_init(&scene->byte_memory, 12, 4);
    CHECK_OK(slc_residency_set_class(scene->residency, 2, UINT64_MAX, &memory));
    begin(scene);
    request_bytes(scene, 300, 12, 0);
    settle(scene, 12);
    end_reads(scene);
    begin(scene);
    use(scene, 300, 2);
    settle(scene, 0);
    begin(scene);
    use(scene, 300, 2);
    request_bytes(scene, 400, 2, 1);
    settle(scene, 2);
    end_reads(scene);
    begin(scene);
    use(scene, 300, 2);
    use(scene, 400, 2);
    request_bytes(scene, 311, 1, 0);
    settle(scene, 1);
    end_reads(scene);
    slc_residency_forget(scene->residency, 400, 1);
    show(scene);
}

/* Pages without a callback: answered late, never answered, and withdrawn. Two more pages, one of
 * them pinned, are set before they are missed. */
static void play_answers(struct scene *scene)
{
    const struct slc_page_request pinned = {.page = 500, .class_index = 1, .pinned = 1};
    const struct slc_page_request other = {.page = 501, .class_index = 1};
    CHECK_OK(slc_residency_set_class(scene->residency, 1, 4, NULL));
    request(scene, &pinned);
    request(scene, &other);
    end_reads(scene); /* set */
    begin(scene);
    use(scene, 500, 2);
    for (uint32_t i = 0; i < 3; i++) /* the third has no room */
        request(scene, &(struct slc_page_request){.page = 510 + i, .class_index = 1});
    settle(scene, 3);
    show(scene); /* none is answered yet */
    begin(scene);
    use(scene, 500, 2);
    request(scene, &(struct slc_page_request){.page = 510, .class_index = 1}); /* pending */
    settle(scene, 1);
    slc_residency_loaded(scene->residency, 511, 99);
    slc_residency_forget(scene->residency, 510, 1); /* no answer */
    slc_residency_failed(scene->residency, 510, false);
    scene->loading_count = 0;
    begin(scene);
    use(scene, 511, 1);
    request(scene, &(struct slc_page_request){.page = 510, .class_index = 1});
    settle(scene, 1);
    end_reads(scene);
    slc_residency_forget(scene->residency, 511, 1); /* taken back */
    begin(scene);
    for (uint32_t i = 0; i < 4; i++) /* all go but the one that is pinned */
        request(scene, &(struct slc_page_request){.page = 520 + i, .class_index = 1});
    settle(scene, 4);
    end_reads(scene);
    show(scene);
}

static void record(const char *folder, const char *name, void (*play)(struct scene *scene),
                   uint32_t class_count, bool no_lod_bias)
{
    char path[1024];
    struct scene scene = {0};
    SluiceRecorder *recorder;
    const struct slc_page_residency_create_info info = {.class_count = class_count,
                                                        .no_lod_bias = no_lod_bias};
    snprintf(path, sizeof path, "%s/demand_%s.trace", folder, name);
    const SluiceFileRecordingInfo file = {.structSize = sizeof file, .pPath = path};
    fake_memory_init(&scene.memory, 64, 4);
    CHECK_OK(slc_residency_create(&info, &scene.residency));
    limit_tiles(&scene, 64);
    CHECK_OK(slc_begin_demand_file_recording(scene.residency, &file, &recorder));
    play(&scene);
    CHECK_OK(sluiceEndRecording(recorder));
    slc_residency_destroy(scene.residency);
}

static void record_random(const char *folder)
{
    char path[1024];
    struct demand_app app;
    SluiceRecorder *recorder;
    snprintf(path, sizeof path, "%s/demand_random.trace", folder);
    const SluiceFileRecordingInfo file = {.structSize = sizeof file, .pPath = path};
    demand_app_init(&app, 2024, true);
    CHECK_OK(slc_begin_demand_file_recording(app.residency, &file, &recorder));
    demand_app_run(&app, 300);
    CHECK_OK(sluiceEndRecording(recorder));
    demand_app_finish(&app);
}

void write_golden_demand(const char *folder)
{
    record(folder, "first_launches", play_first_launches, 2, false);
    record(folder, "eviction", play_eviction, 2, false);
    record(folder, "bias", play_bias, 2, false);
    record(folder, "refusals", play_refusals, 2, true);
    record(folder, "formats", play_formats, 2, false);
    record(folder, "failures", play_failures, 2, false);
    record(folder, "resources", play_resources, 2, false);
    record(folder, "bytes", play_bytes, 3, false);
    record(folder, "answers", play_answers, 3, false);
    record_random(folder);
}
