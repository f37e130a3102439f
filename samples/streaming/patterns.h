/**
 * Patterns of the pictures, the floor and the walls. Functions of position, so that each can be
 * generated at any size.
 */
#ifndef SAMPLES_STREAMING_PATTERNS_H
#define SAMPLES_STREAMING_PATTERNS_H

/**
 * Linear color at (u, v). v runs from 0 at the top to 1 at the bottom; u has the same scale.
 * `footprint`: size of a texel in that scale. Finer detail is averaged away.
 */
typedef void (*pattern_fn)(float u, float v, float footprint, float rgb[3]);

void pattern_coast(float u, float v, float footprint, float rgb[3]);
void pattern_julia(float u, float v, float footprint, float rgb[3]);
void pattern_mandelbrot(float u, float v, float footprint, float rgb[3]);
void pattern_chart(float u, float v, float footprint, float rgb[3]);
void pattern_glass(float u, float v, float footprint, float rgb[3]);
void pattern_nebula(float u, float v, float footprint, float rgb[3]);
void pattern_guilloche(float u, float v, float footprint, float rgb[3]);

/* These patterns repeat when u or v grows by 1. */
void pattern_parquet(float u, float v, float footprint, float rgb[3]);
void pattern_wallpaper(float u, float v, float footprint, float rgb[3]);
/** Height of a canvas and the paint on it, 0 to 1, in rgb[0]. Does not repeat. */
void pattern_canvas(float u, float v, float footprint, float rgb[3]);

/** Color, height and roughness of one mosaic, for a set of textures. */
void pattern_mosaic(float u, float v, float footprint, float rgb[3]);
void pattern_mosaic_height(float u, float v, float footprint, float rgb[3]);
void pattern_mosaic_roughness(float u, float v, float footprint, float rgb[3]);

#endif /* SAMPLES_STREAMING_PATTERNS_H */
