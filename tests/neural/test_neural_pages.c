/* Pages of latents: every texel decodes from its page to the bits that all latents give. */
#include "neural/neural_files.h"
#include "neural/worked_example.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include "base/checked.h"

#include <sluice/neural_pages.h>

#include <stdlib.h>
#include <string.h>

static const char *const samples[] = {"v7_64_g.ntc", "v9_64_g.ntc", "v9_300x200.ntc"};

/* A set, its weights, and all its latents. */
struct whole {
    SluiceNeuralSet *set;
    SluiceNeuralSetInfo info;
    void *weights, *latents;
    uint64_t weight_size, latent_size;
    SluiceNeuralConstants constants;
};

static bool whole_init(struct whole *w, const char *sample)
{
    char path[512];
    *w = (struct whole){.info = {.structSize = sizeof w->info}};
    if (!find_neural_sample(sample, path, sizeof path))
        return false;
    w->set = open_neural_sample(path);
    CHECK_OK(sluiceGetNeuralSetInfo(w->set, &w->info));
    CHECK_OK(
        sluiceGetNeuralWeights(w->set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &w->weight_size, NULL));
    w->weights = malloc(w->weight_size);
    CHECK_OK(sluiceGetNeuralWeights(w->set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &w->weight_size,
                                    w->weights));
    CHECK_OK(sluiceReadNeuralLatents(w->set, NULL, &w->constants, &w->latent_size, NULL));
    w->latents = malloc(w->latent_size);
    CHECK_OK(sluiceReadNeuralLatents(w->set, NULL, &w->constants, &w->latent_size, w->latents));
    return true;
}

static void whole_finish(struct whole *w)
{
    sluiceDestroyNeuralSet(w->set);
    free(w->weights);
    free(w->latents);
}

struct rectangle {
    uint32_t mip, x, y, width, height;
};

/* Free the result. */
static float *decode(const struct whole *w, const SluiceNeuralConstants *constants,
                     const void *latents, uint64_t latent_size, const struct rectangle *r)
{
    float *texels = malloc(sizeof(float) * r->width * r->height * w->info.channelCount);
    CHECK_OK(sluiceDecodeNeuralTexels(
        &(SluiceNeuralDecodeInfo){.structSize = sizeof(SluiceNeuralDecodeInfo),
                                  .pConstants = constants,
                                  .pLatents = latents,
                                  .latentSize = latent_size,
                                  .pWeights = w->weights,
                                  .weightSize = w->weight_size,
                                  .mip = r->mip,
                                  .x = r->x,
                                  .y = r->y,
                                  .width = r->width,
                                  .height = r->height,
                                  .channelCount = w->info.channelCount,
                                  .pTexels = texels}));
    return texels;
}

static void compare(const struct whole *w, const SluiceNeuralPages *pages, const uint8_t *page,
                    const struct rectangle *r)
{
    SluiceNeuralConstants constants;
    memcpy(&constants, page, sizeof constants);
    float *a =
        decode(w, &constants, page + sizeof constants, pages->pageSize - sizeof constants, r);
    float *b = decode(w, &w->constants, w->latents, w->latent_size, r);
    if (memcmp(a, b, sizeof *a * r->width * r->height * w->info.channelCount))
        fail_msg("mip %u, texels from %u, %u differ", r->mip, r->x, r->y);
    free(a);
    free(b);
}

/* The texels of a mip that look for their latents in page (column, row): brute force. */
static struct rectangle texels_of(const struct whole *w, const SluiceNeuralPageGroup *group,
                                  uint32_t mip, uint32_t column, uint32_t row)
{
    uint32_t fine = mip - group->firstMip, x0 = UINT32_MAX, x1 = 0, y0 = UINT32_MAX, y1 = 0;
    for (uint32_t x = 0; x < slc_mip_size(w->info.width, mip); x++)
        if ((x << fine) / group->pageWidth == column) {
            x0 = slc_min_u32(x0, x);
            x1 = x + 1;
        }
    for (uint32_t y = 0; y < slc_mip_size(w->info.height, mip); y++)
        if ((y << fine) / group->pageHeight == row) {
            y0 = slc_min_u32(y0, y);
            y1 = y + 1;
        }
    if (x0 >= x1 || y0 >= y1)
        return (struct rectangle){0};
    return (struct rectangle){mip, x0, y0, x1 - x0, y1 - y0};
}

static uint64_t check_pages(const struct whole *w, const SluiceNeuralPages *pages)
{
    uint8_t *page = malloc(pages->pageSize);
    uint64_t texels = 0;
    for (uint32_t g = 0; g < pages->groupCount; g++) {
        const SluiceNeuralPageGroup *group = &pages->groups[g];
        for (uint32_t i = 0; i < group->columns * group->rows; i++) {
            memset(page, 0xA5, pages->pageSize);
            CHECK_OK(sluiceReadNeuralPage(w->set, pages, group->firstPage + i, page));
            for (uint32_t mip = group->firstMip; mip < group->firstMip + group->mipCount; mip++) {
                struct rectangle r =
                    texels_of(w, group, mip, i % group->columns, i / group->columns);
                texels += (uint64_t)r.width * r.height;
                if (r.width)
                    compare(w, pages, page, &r);
            }
        }
    }
    free(page);
    return texels;
}

static void every_texel_decodes_from_its_page(void **state)
{
    (void)state;
    for (size_t s = 0; s < sizeof samples / sizeof samples[0]; s++) {
        struct whole w;
        if (!whole_init(&w, samples[s]))
            SKIP_TEST("the sample is not there");
        uint64_t all = 0;
        for (uint32_t mip = 0; mip < w.info.mipCount; mip++)
            all += (uint64_t)slc_mip_size(w.info.width, mip) * slc_mip_size(w.info.height, mip);
        for (uint32_t size = 65536; size >= 2048; size /= 32) {
            if (size == 65536 && w.info.width > 64)
                continue; /* more texels, and one page as for the others */
            SluiceNeuralPages pages;
            CHECK_OK(sluiceLayOutNeuralPages(w.set, size, &pages));
            assert_true(pages.pageSize <= size);
            assert_int_equal(check_pages(&w, &pages), all);
        }
        whole_finish(&w);
    }
}

static void pages_are_as_large_as_allowed(void **state)
{
    struct whole w;
    SluiceNeuralPages pages;
    (void)state;
    if (!whole_init(&w, "v9_64_g.ntc"))
        SKIP_TEST("the sample is not there");
    CHECK_OK(sluiceLayOutNeuralPages(w.set, 1 << 20, &pages));
    assert_int_equal(pages.pageCount, pages.groupCount);    /* a group fits into a page */
    CHECK_OK(sluiceLayOutNeuralPages(w.set, 2048, &pages)); /* edges are halved */
    assert_true(pages.pageSize > 512 && pages.groups[0].columns > 1);
    CHECK_RESULT(sluiceLayOutNeuralPages(w.set, 600, &pages), SLUICE_ERROR_LIMIT_EXCEEDED);
    whole_finish(&w);
}

static uint8_t example[WORKED_EXAMPLE_MAX_SIZE];

static void every_refused_allocation_of_a_page_is_survived(void **state)
{
    size_t size = write_worked_example(example);
    uint8_t page[4096];
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint32_t allowed = 0;
    (void)state;
    for (; result != SLUICE_SUCCESS; allowed++) {
        struct failing_allocator allocator;
        SluiceNeuralSet *set = NULL;
        SluiceNeuralPages pages;
        failing_allocator_init(&allocator, allowed);
        result = open_neural_bytes(example, size, &allocator.callbacks, &set);
        if (result == SLUICE_SUCCESS) {
            uint64_t calls = allocator.calls;
            CHECK_OK(sluiceLayOutNeuralPages(set, sizeof page, &pages));
            assert_int_equal(allocator.calls, calls);
            result = sluiceReadNeuralPage(set, &pages, 0, page);
        }
        if (result != SLUICE_SUCCESS)
            assert_int_equal(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceDestroyNeuralSet(set);
        assert_int_equal(allocator.live_count, 0);
    }
    assert_true(allowed > 2);
}

static void pages_that_do_not_exist_are_refused(void **state)
{
    struct whole w;
    SluiceNeuralPages pages;
    uint8_t *page = malloc(65536);
    (void)state;
    if (!whole_init(&w, "v9_64_g.ntc"))
        SKIP_TEST("the sample is not there");
    CHECK_OK(sluiceLayOutNeuralPages(w.set, 4096, &pages));
    CHECK_RESULT(sluiceReadNeuralPage(w.set, &pages, pages.pageCount, page),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    pages.groups[0].pageWidth *= 2;
    CHECK_RESULT(sluiceReadNeuralPage(w.set, &pages, 0, page), SLUICE_ERROR_INVALID_ARGUMENT);
    whole_finish(&w);
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_decodes_from_its_page),
        cmocka_unit_test(pages_are_as_large_as_allowed),
        cmocka_unit_test(every_refused_allocation_of_a_page_is_survived),
        cmocka_unit_test(pages_that_do_not_exist_are_refused),
    };
    return RUN_TESTS(tests);
}
