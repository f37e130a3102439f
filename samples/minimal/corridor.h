/** Scene, command line and output of minimal.c. */
#ifndef SAMPLES_MINIMAL_CORRIDOR_H
#define SAMPLES_MINIMAL_CORRIDOR_H

#include <sluice/vulkan.h>

#include <stdbool.h>
#include <stdint.h>

#define TEXTURES 3
#define SURFACES 4 /* floor, left and right wall, end */

struct settings {
    SluiceResidencyMode mode;
    uint32_t size[2];     ///< picture size: width, height in pixels
    uint32_t walk_frames; ///< number of frames in which the eye moves
    uint32_t frames;      ///< number of all frames; the eye rests in the last ones
    bool everything;      ///< stream every tile, seen or not
    const char *output;   ///< file for the last picture; borrowed from argv
};

/** Parses the command line. Exits after --help, and with status 2 after an error. */
struct settings read_settings(int argc, char **argv);

/** Texture index of a surface, from 0. */
uint32_t texture_of_surface(uint32_t surface);
/** Position of the eye on the z axis in a frame. It walks from 1 to -3. */
float eye_in_frame(const struct settings *settings, uint32_t frame);

/** Creates a procedural source of stones. Tiles are painted when they are loaded. */
SluiceResult create_source(uint32_t texture, SluiceImageSource **source);

/** Prints a line: residency mode, frames, counts of all, resident and loaded tiles, bytes. */
void print_statistics(const SluiceVulkanStreamer *streamer, uint32_t frames);
/** Writes the picture. Reports errors and returns false. `texels`: [height][width] RGBA. */
bool write_picture(const struct settings *settings, const uint8_t *texels);

#endif /* SAMPLES_MINIMAL_CORRIDOR_H */
