/** Cube map of a sky over a lake with mountains. Its faces are painted on demand. */
#ifndef SAMPLES_SKY_FACES_H
#define SAMPLES_SKY_FACES_H

#include <sluice/image.h>

#define FACES 6

/** The sources of the faces, and one source of all six as layers. Zeroed is empty. */
struct faces {
    SluiceImageSource *faces[FACES], *cube;
};

/** `size`: texels of an edge. After an error, destroy the faces too. */
SluiceResult faces_create(uint32_t size, struct faces *faces);
void faces_destroy(struct faces *faces);

#endif /* SAMPLES_SKY_FACES_H */
