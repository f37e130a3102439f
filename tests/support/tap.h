/** Makes cmocka's output TAP that every version of Meson reads, with a reason on each skipped test.
 */
#ifndef TESTS_SUPPORT_TAP_H
#define TESTS_SUPPORT_TAP_H

/**
 * Replaces stdout by a filter, from here to the end of the program. Older cmocka writes a skipped
 * test as "not ok", which older Meson counts as a failure, and lets through lines that are no TAP.
 */
void tap_filter_stdout(void);

#endif /* TESTS_SUPPORT_TAP_H */
