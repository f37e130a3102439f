/** Colors of FLIP: opponent colors for the filters, and the distance of two filtered colors. */
#ifndef SLC_METRICS_FLIP_COLOR_H
#define SLC_METRICS_FLIP_COLOR_H

/**
 * Luminance, red against green, blue against yellow: YCxCz without its scales and offset, which
 * filters of sum 1 pass through. `rgb` is linear.
 */
void slc_opponents_from_linear(const double rgb[3], double opponents[3]);

/** The curve from distances to errors, as logarithms. */
struct slc_flip_curve {
    double largest;    ///< distance of blue and green; shares are relative to it
    double knee;       ///< share where the curve bends
    double knee_slope; ///< error by share below it
};

void slc_flip_curve_init(struct slc_flip_curve *curve);

/**
 * The error of two filtered colors, in [0, 1]: brought into the cube of RGB, in L*a*b* with Hunt's
 * adjustment, apart by HyAB, compressed; and raised by the error of features, `feature` in [0, 1].
 */
double slc_flip_error(const struct slc_flip_curve *curve, const double a[3], const double b[3],
                      double feature);

#endif /* SLC_METRICS_FLIP_COLOR_H */
