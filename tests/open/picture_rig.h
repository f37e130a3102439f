/** An opener with a cache folder, and a picture that it bakes. */
#ifndef TEST_OPEN_PICTURE_RIG_H
#define TEST_OPEN_PICTURE_RIG_H

#include <sluice/open.h>
#include <sluice/store.h>

#include "bake/baked.h"

#include <stdatomic.h>

enum { PICTURE_WIDTH = 1300, PICTURE_HEIGHT = 700 };

struct picture_fixture {
    struct bake_folder folder;
    char cache[400], png[256];
    SluiceImageOpener *opener;
    atomic_int errors, warnings;
    char last[1024], last_warning[1024];
};

/** Counts warnings and errors, and keeps the last of each. `user` is the fixture. */
void picture_log(void *user, SluiceLogSeverity severity, const char *message);
void write_picture(const char *path, uint32_t width, uint32_t height, uint32_t seed);
void picture_opener(struct picture_fixture *f, uint64_t max_cache_size);
void picture_setup(struct picture_fixture *f);
void picture_teardown(struct picture_fixture *f);
void store_path(const struct picture_fixture *f, const char *picture, char path[512]);
SluiceOpenedImageInfo state_of(SluiceImageSource *source);
void wait_a_little(void);
/** Until a bake has ended, one way or the other; two minutes at most. */
SluiceOpenedImageInfo wait_for(SluiceImageSource *source);
SluiceResult read_texel(SluiceImageSource *source, uint32_t level, uint8_t texel[4]);
/** Every level is that of a bake of our own. */
void check_baked(struct picture_fixture *f, SluiceImageSource *source, const char *picture);
/** Takes the store as another process would that bakes the same picture. */
SluiceStoreWriter *begin_writing(const char *path);

#endif /* TEST_OPEN_PICTURE_RIG_H */
