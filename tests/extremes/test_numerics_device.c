/*
 * Tests the functions of numerics.h on a device. Bounds are those of docs/numerics.md: Vulkan's
 * precision of float division, sqrt, log2 and exp2 ("Precision of Individual Operations"), and
 * cancellation.
 */
#include "device/conform.h"
#include "extremes/numerics.h"

#include "support/test.h"

#include "numerics_comp.h"

#define CAPACITY 65536u

struct caller {
    struct harness *h;
    struct harness_buffer calls;
    struct conform_set set;
    VkPipeline pipeline;
};

static void caller_init(struct caller *c, struct harness *h)
{
    c->h = h;
    harness_buffer_init(h, &c->calls, CAPACITY * sizeof(struct NumericsCall),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    conform_create_set(h, 1, 0, sizeof(struct NumericsParams), &c->set);
    conform_write_buffers(h, &c->set, 1, (const struct harness_buffer *const[]){&c->calls});
    c->pipeline = conform_compute_pipeline(
        h, c->set.layout, conform_module(h, numerics_comp, sizeof numerics_comp), NULL);
}

static void caller_finish(struct caller *c)
{
    c->h->DestroyPipeline(c->h->device, c->pipeline, NULL);
    conform_destroy_set(c->h, &c->set);
    harness_buffer_finish(c->h, &c->calls);
}

/* Runs cases [first, first + count), at most CAPACITY. */
static void run_cases(struct caller *c, uint32_t function, uint64_t first, uint32_t count,
                      struct extremes_row *rows)
{
    const struct numerics_function *f = numerics_find(function);
    struct NumericsCall *calls = c->calls.mapped;
    for (uint32_t i = 0; i < count; i++) {
        calls[i] = (struct NumericsCall){0};
        f->make(first + i, calls[i].arguments);
    }
    struct NumericsParams params = {function, count};
    struct conform_job job = {.set = &c->set,
                              .stage = CONFORM_STAGE_COMPUTE,
                              .pipeline = c->pipeline,
                              .count = count,
                              .push = &params,
                              .push_size = sizeof params};
    conform_run_job(c->h, &job);
    for (uint32_t i = 0; i < count; i++)
        f->check(calls[i].arguments, calls[i].results, true, rows);
}

static void check_functions(struct harness *h, uint32_t first, uint32_t count)
{
    struct caller c;
    caller_init(&c, h);
    for (uint32_t function = first; function < first + count; function++) {
        const struct numerics_function *f = numerics_find(function);
        struct extremes_row rows[NUMERICS_ROWS];
        numerics_begin(f, true, rows);
        uint64_t many = f->many / 4 > f->quick ? f->many / 4 : f->quick;
        uint64_t cases = extremes_count(f->quick, many);
        for (uint64_t at = 0; at < cases; at += CAPACITY)
            run_cases(&c, function, at, (uint32_t)(cases - at < CAPACITY ? cases - at : CAPACITY),
                      rows);
        numerics_end(f, true, rows);
    }
    caller_finish(&c);
}

static void levels_of_detail_are_near_exact_ones(void **state)
{
    check_functions(*state, 0, NUMERICS_LOD_COUNT);
}

static void regions_and_decisions_are_near_exact_ones(void **state)
{
    check_functions(*state, NUMERICS_LOD_COUNT, NUMERICS_REGION_COUNT);
}

static void texels_of_pages_and_weights_are_near_exact_ones(void **state)
{
    check_functions(*state, NUMERICS_LOD_COUNT + NUMERICS_REGION_COUNT, NUMERICS_PAGE_COUNT);
}

int main(int argc, char **argv)
{
    struct harness h;
    if (!extremes_begin(argc, argv))
        return 2;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_of_detail_are_near_exact_ones),
        cmocka_unit_test(regions_and_decisions_are_near_exact_ones),
        cmocka_unit_test(texels_of_pages_and_weights_are_near_exact_ones),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
