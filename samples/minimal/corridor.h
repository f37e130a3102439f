/** What minimal.c shows, what it is told on the command line, and what it prints. */
#ifndef SAMPLES_MINIMAL_CORRIDOR_H
#define SAMPLES_MINIMAL_CORRIDOR_H

#include <sluice/vulkan.h>

#include <stdbool.h>
#include <stdint.h>

#define TEXTURES 3
#define SURFACES 4 /* floor, left and right wall, end */

struct settings {
    SluiceResidencyMode mode;
    uint32_t size[2];     ///< of the picture: width, height in pixels
    uint32_t walk_frames; ///< in which the eye moves
    uint32_t frames;      ///< in all; the eye rests in those at the end
    bool everything;      ///< stream every tile, seen or not
    const char *output;   ///< the last picture's file; borrowed from argv
};

/** Ends the program after --help, and with status 2 if the command line is wrong. */
struct settings read_settings(int argc, char **argv);

/** Which texture a surface has, from 0. */
uint32_t texture_of_surface(uint32_t surface);
/** Where the eye is in a frame, on the z axis: it walks from 1 to -3. */
float eye_in_frame(const struct settings *settings, uint32_t frame);

/** A source of texels for a texture: stones, painted where and when a tile of them is loaded. */
SluiceResult create_source(uint32_t texture, SluiceImageSource **source);

/** A line: residency mode, frames so far, tiles there are, are resident and were loaded, bytes. */
void print_statistics(const SluiceVulkanStreamer *streamer, uint32_t frames);
/** Returns false if the file cannot be written, having said why. `texels`: [height][width] RGBA. */
bool write_picture(const struct settings *settings, const uint8_t *texels);

#endif /* SAMPLES_MINIMAL_CORRIDOR_H */
