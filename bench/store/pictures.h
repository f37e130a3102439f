/** Image sources of picture files, and files made from them, which are read while the clock
 * runs. */
#ifndef BENCH_STORE_PICTURES_H
#define BENCH_STORE_PICTURES_H

#include <sluice/store.h>

/** A binary PPM file of 8 bits as R8G8B8A8_SRGB, or an OpenEXR file in that format. NULL, and a
 *  message, if it cannot be read. */
SluiceImageSource *open_picture(const char *path);

/** Any OpenEXR file; as above. */
SluiceImageSource *open_exr(const char *path, SluiceFormat format);
/** `pool` may be NULL. */
SluiceImageSource *open_store(const char *path, SluiceStoreReadPool *pool, bool checks_always);

/** Every level of `source`. Ends the program on errors. */
void write_store(const char *path, SluiceImageSource *source, uint32_t compression);
/** Tiles of the source's standard shape as RGBA16F, ZIP. */
void write_exr(const char *path, SluiceImageSource *source);

#endif /* BENCH_STORE_PICTURES_H */
