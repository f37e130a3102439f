/** The parts of the micro program; each runs in a process of its own. */
#ifndef BENCH_MICRO_H
#define BENCH_MICRO_H

void bench_feedback(void);
void bench_follow(void);
void bench_idle(void);
void bench_add(void);
void bench_memory(void);
void bench_heaps(void);
/** Times with n and with 2n: a ratio of 4 is a square. */
void bench_growth(void);
void bench_copy(void);

/* Needs the harness's sltrace.h. */
void bench_cut(void);
/** Copies the maps of a trace, frame by frame: what reading them costs at the very least. */
void bench_floor(const char *trace);

#endif /* BENCH_MICRO_H */
