/* NULL and zero in every argument of the functions of sluice-store. */
#include "null_arguments/calls.h"
#include "null_arguments/files.h"

#include <sluice/store.h>

/* clang-format off */
/* CALLS
sluiceGetStoreLayout(16, 16, SLUICE_FORMAT_R8_UNORM, &f->out.layout)
sluiceGetStoreTileRegion(&f->layout, 0, 0, 0, &f->out.region)
sluiceCreateStoreWriter(&f->create, &f->out.writer) => sluiceDestroyStoreWriter(f->out.writer)
sluiceGetStoreWriterLayout(f->writer, &f->out.layout)
sluiceGetStoreProgress(f->writer, &f->out.written, &f->out.count)
sluiceIsStoreTileWritten(f->writer, 0, 0, 0, 0, &f->out.is_written)
!sluiceWriteStoreTile(f->writer, 0, 0, 0, 0, f->texels, 512)
!sluiceWriteStoreTileInTurn(f->writer, 0, 0, 0, 0, 0, ?f->texels, 512)
!sluiceWriteStoreTail(f->writer, 0, f->levels, ?f->pitches)
!sluiceFinishStore(f->writer)
!sluiceDestroyStoreWriter(f->writer)
sluiceCreateStoreReadPool(?NULL, &f->out.pool) => sluiceDestroyStoreReadPool(f->out.pool)
!sluiceDestroyStoreReadPool(NULL)
sluiceCreateStoreImageSource(&f->open, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceGetStoreInfo(f->store, &f->out.info)
sluiceHashStore(f->store, &f->out.count)
sluiceVerifyStore(&f->verify, ?&f->out.report)
*/
/* clang-format on */

struct fixture {
    struct files files;
    SluiceStoreCreateInfo create;
    SluiceStoreWriter *writer;
    char writing[80];
    SluiceStoreLayout layout;
    uint8_t texels[4 * 128 * 128];
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    size_t pitches[SLUICE_STORE_MAX_MIP_LEVELS];
    SluiceStoreImageSourceCreateInfo open;
    SluiceStoreVerifyInfo verify;
    SluiceImageSource *store;
    struct {
        SluiceStoreLayout layout;
        SluiceImageRegion region;
        SluiceStoreWriter *writer;
        uint64_t written, count;
        bool is_written;
        SluiceStoreReadPool *pool;
        SluiceImageSource *source;
        SluiceStoreInfo info;
        SluiceStoreReport report;
    } out;
};

CALLS_FUNCTIONS

static SluiceStoreWriter *begin(const struct fixture *f, const char *path)
{
    SluiceStoreCreateInfo create = f->create;
    SluiceStoreWriter *writer;
    create.pPath = path;
    CHECK_OK(sluiceCreateStoreWriter(&create, &writer));
    return writer;
}

static void write_all(struct fixture *f, SluiceStoreWriter *writer)
{
    const SluiceStoreLayout *layout = &f->layout;
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout->levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout->levelWidthInTiles[l]; x++)
                CHECK_OK(sluiceWriteStoreTile(writer, 0, l, x, y, f->texels, 512));
    CHECK_OK(sluiceWriteStoreTail(writer, 0, f->levels, f->pitches));
    CHECK_OK(sluiceFinishStore(writer));
    sluiceDestroyStoreWriter(writer);
}

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    files_init(&f->files);
    f->create = (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                        .pPath = f->files.output,
                                        .width = 256,
                                        .height = 256,
                                        .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    CHECK_OK(sluiceGetStoreLayout(256, 256, SLUICE_FORMAT_R8G8B8A8_UNORM, &f->layout));
    assert_in_range(f->layout.tailFirstLevel, 1, 8);
    for (uint32_t i = 0; i < SLUICE_STORE_MAX_MIP_LEVELS; i++) {
        f->levels[i] = f->texels;
        f->pitches[i] = 512;
    }
    write_all(f, begin(f, f->files.input));
    snprintf(f->writing, sizeof f->writing, "%s2", f->files.output);
    f->writer = begin(f, f->writing);
    f->open = (SluiceStoreImageSourceCreateInfo){
        .structSize = sizeof(SluiceStoreImageSourceCreateInfo), .pPath = f->files.input};
    f->verify = (SluiceStoreVerifyInfo){.structSize = sizeof(SluiceStoreVerifyInfo),
                                        .pPath = f->files.input};
    CHECK_OK(sluiceCreateStoreImageSource(&f->open, &f->store));
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyImageSource(f->store);
    sluiceDestroyStoreWriter(f->writer);
    files_finish(&f->files);
}

#include "store_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
