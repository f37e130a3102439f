/** Colours of FLIP: opponents, which are filtered, and how far two filtered ones are apart. */
#ifndef SLC_METRICS_FLIP_COLOUR_H
#define SLC_METRICS_FLIP_COLOUR_H

/**
 * Luminance, red against green, blue against yellow: YCxCz without its scales and offset, which
 * filters of sum 1 pass through. `rgb` is linear.
 */
void slc_opponents_from_linear(const double rgb[3], double opponents[3]);

/** The distance that FLIP gives to blue and green, of which others are a share. */
double slc_flip_largest_distance(void);

/**
 * The colour error of two filtered colours, in [0, 1]: brought into the cube of RGB, in L*a*b* with
 * Hunt's adjustment, apart by HyAB, compressed.
 */
double slc_flip_colour_error(const double a[3], const double b[3], double largest_distance);

#endif /* SLC_METRICS_FLIP_COLOUR_H */
