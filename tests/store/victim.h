/** A small file that a test damages: 300 x 140 texels of R8G8B8A8_UNORM, PICTURE_SMOOTH. */
#ifndef TESTS_STORE_VICTIM_H
#define TESTS_STORE_VICTIM_H

#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>

struct victim {
    struct scratch scratch;
    unsigned char *bytes; ///< original bytes, and room for one more
    size_t size;
};

static inline void victim_init(struct victim *victim, uint32_t compression)
{
    scratch_init(&victim->scratch);
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = victim->scratch.path,
                                  .width = 300,
                                  .height = 140,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pSourceName = "picture.png",
                                  .compressionLevel = compression};
    CHECK_OK(write_store(&info, PICTURE_SMOOTH));
    victim->bytes = read_bytes(victim->scratch.path, &victim->size);
}

static inline void victim_finish(struct victim *victim)
{
    free(victim->bytes);
    scratch_finish(&victim->scratch);
}

#endif /* TESTS_STORE_VICTIM_H */
