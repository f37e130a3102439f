/**
 * The random numbers of the tests: the same on every machine, with every libc and compiler, so that
 * a failure can be seen again elsewhere. The libc's generator differs between systems; the style
 * check refuses it.
 *
 * A program has one sequence. Each test that rolls begins with roll_seed(), so that it rolls the
 * same numbers when it runs alone. Not for use by several threads.
 */
#ifndef TESTS_SUPPORT_ROLL_H
#define TESTS_SUPPORT_ROLL_H

#include <stdint.h>

#define ROLL_MAX INT32_MAX

/** Begins the sequence of `seed`. A program that seeds nothing rolls the sequence of seed 0. */
void roll_seed(uint64_t seed);

/** 0 to ROLL_MAX, both included. Two rolls in the arguments of one call have no order. */
int roll(void);

#endif /* TESTS_SUPPORT_ROLL_H */
