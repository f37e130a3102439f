#include "demand_app.h"

#include "demand/random.h"
#include "replay/demand_recorder.h"
#include "support/test.h"

static uint32_t below(struct demand_app *app, uint32_t limit)
{
    return random_below(&app->random, limit);
}

/* Low ids, and the highest there are. */
static uint32_t id_of(uint32_t page)
{
    return page < DEMAND_APP_PAGES / 2 ? 5 * page : INT32_MAX - (DEMAND_APP_PAGES - 1 - page);
}

static uint32_t class_of(uint32_t page)
{
    return page % 4 == 3 ? 0 : page % 4;
}

static void set_class(struct demand_app *app, uint32_t c, uint64_t limit)
{
    struct slc_page_memory memory = fake_page_memory(&app->memory[c]);
    CHECK_OK(slc_residency_set_class(app->residency, c, limit, c == 1 ? NULL : &memory));
}

void demand_app_init(struct demand_app *app, uint64_t seed, bool starved)
{
    *app = (struct demand_app){.random = seed * 0x9E3779B97F4A7C15u + 1, .starved = starved};
    failing_allocator_init(&app->allocator, UINT64_MAX);
    const struct slc_page_residency_create_info info = {.cb = &app->allocator.callbacks,
                                                        .class_count = DEMAND_APP_CLASSES,
                                                        .no_eviction = seed % 11 == 10,
                                                        .no_lod_bias = seed % 3 == 2};
    CHECK_OK(slc_residency_create(&info, &app->residency));
    for (uint32_t c = 0; c < DEMAND_APP_CLASSES; c++) {
        uint32_t limit = 4 + below(app, 24);
        fake_memory_init(&app->memory[c], limit + below(app, 6), 3);
        if (c != 1 || below(app, 2))
            set_class(app, c, limit);
    }
}

void demand_app_finish(struct demand_app *app)
{
    assert_true(slc_residency_check(app->residency));
    slc_residency_destroy(app->residency);
    assert_int_equal(app->allocator.live_count, 0);
}

static void request(struct demand_app *app, uint32_t page)
{
    const struct slc_page_request wanted = {.page = id_of(page),
                                            .class_index = (uint8_t)class_of(page),
                                            .rank = (uint8_t)(page / 4 % 5),
                                            .pinned = page % 13 == 12,
                                            .kind = page / 8 % 2};
    SluiceResult result;
    if (app->starved && below(app, 4) == 0)
        app->allocator.refuse_from = app->allocator.calls;
    if (slc_residency_request(app->residency, &wanted, &result) == SLC_REQUEST_LOAD)
        app->loading[page] = true;
    app->allocator.refuse_from = UINT64_MAX;
    app->out_of_memory_count += result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void launch(struct demand_app *app)
{
    uint32_t first = below(app, DEMAND_APP_PAGES), missing = below(app, 12);
    app->launch += 1 + below(app, 8) / 7;
    slc_residency_begin(app->residency, app->launch);
    for (uint32_t i = below(app, 40); i > 0; i--)
        slc_residency_use(app->residency, id_of((first + 3 * i) % DEMAND_APP_PAGES));
    for (uint32_t i = 0; i < missing; i++)
        request(app, (first + below(app, 24)) % DEMAND_APP_PAGES);
    slc_residency_settle(app->residency, missing + below(app, 3));
}

static void end_reads(struct demand_app *app)
{
    for (uint32_t page = 0; page < DEMAND_APP_PAGES; page++) {
        if (!app->loading[page] || below(app, 3) == 0)
            continue;
        app->loading[page] = false;
        if (below(app, 8) == 0)
            slc_residency_failed(app->residency, id_of(page), below(app, 2));
        else
            slc_residency_loaded(app->residency, id_of(page), 1000 + ++app->value);
    }
}

static void prepare(struct demand_app *app)
{
    struct slc_page_change changes[DEMAND_APP_PAGES];
    struct slc_page_evicted evicted[7];
    uint64_t next = app->launch + 1 + below(app, 3);
    if (next >= app->prepared) {
        app->prepared = next;
        slc_residency_prepare(app->residency, next);
    }
    slc_residency_take_changes(app->residency, changes,
                               below(app, 3) == 0 ? 1 + below(app, 4) : DEMAND_APP_PAGES);
    slc_residency_take_evicted(app->residency, evicted, 7);
    if (below(app, 16) == 0 && app->prepared > app->launch) {
        slc_residency_abandon(app->residency, app->prepared);
        app->prepared--;
    }
}

static void step(struct demand_app *app)
{
    uint32_t page = below(app, DEMAND_APP_PAGES), c;
    switch (below(app, 16)) {
    case 0: request(app, page); break; /* outside of launches, as preloading does */
    case 1: slc_residency_forget(app->residency, id_of(page), 1 + below(app, 12)); break;
    case 2: slc_residency_retry(app->residency, id_of(page)); break;
    case 3:
        c = below(app, DEMAND_APP_CLASSES);
        if (below(app, 4) == 0)
            set_class(app, c, below(app, 28));
        break;
    case 4:
    case 5:
    case 6:
    case 7: prepare(app); break;
    case 8:
    case 9:
    case 10:
    case 11: end_reads(app); break;
    default: launch(app); break;
    }
}

void demand_app_run(struct demand_app *app, uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++)
        step(app);
}

void record_demand_run(struct trace_buffer *buffer, uint64_t seed, uint32_t steps, bool starved)
{
    struct demand_app app;
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(buffer);
    demand_app_init(&app, seed, starved);
    CHECK_OK(slc_begin_demand_recording(app.residency, &writer, NULL, &recorder));
    demand_app_run(&app, steps);
    CHECK_OK(sluiceEndRecording(recorder));
    demand_app_finish(&app);
}
