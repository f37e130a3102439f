/** Times, memory, and one line of output per figure. */
#ifndef BENCH_FIGURES_H
#define BENCH_FIGURES_H

#include <stdbool.h>
#include <stdint.h>

/** Durations of one thing done many times. */
struct samples {
    double *ns;
    uint32_t count, room;
};

struct options {
    bool json, quick;
};

extern struct options options;

uint64_t now_ns(void);

/** Bytes of this process that are in memory, counted exactly; 0 if the system does not say. */
uint64_t resident_size(void);

/** Repetitions: `full` of them, or a tenth with --quick, but some. */
uint32_t repetitions(uint32_t full);

void samples_init(struct samples *samples, uint32_t room);
void samples_add(struct samples *samples, double ns);
void samples_finish(struct samples *samples);

double samples_mean(const struct samples *samples);
/** The value that a share of the samples (0 to 1) is below. Sorts them. */
double samples_quantile(struct samples *samples, double share);

/** Prints one figure; `part` is appended to the name after a dot unless NULL. */
void figure(const char *name, const char *part, double value, const char *unit);

/** Prints median and minimum in microseconds. */
void figure_times(const char *name, struct samples *samples);

/** Prints median, mean and 99th percentile in microseconds. */
void figure_frames(const char *name, struct samples *samples);

/** Never optimized away: memory at `p` may have been read and written. */
static inline void touched(const void *p)
{
    __asm__ volatile("" : : "r"(p) : "memory");
}

#endif /* BENCH_FIGURES_H */
