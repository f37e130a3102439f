/** Machine-readable results of a self-test: lines with tabs between fields. */
#ifndef TOOLS_SLUICE_INFO_SELF_TEST_CHECKS_H
#define TOOLS_SLUICE_INFO_SELF_TEST_CHECKS_H

#include <stdio.h>

/**
 * Sets where tests report: "begin NAME", then "end NAME RESULT SECONDS REASON". RESULT is pass,
 * fail or skip. The reason is empty for pass.
 */
void self_test_report_to(FILE *out);

#endif /* TOOLS_SLUICE_INFO_SELF_TEST_CHECKS_H */
