/** Command line of the oracle. Names are those of samples/demand-pbrt. */
#ifndef TESTS_ORACLE_OPTIONS_H
#define TESTS_ORACLE_OPTIONS_H

#include "oracle/oracle.h"

#include "../../tools/common/option_table.h"

struct oracle_options {
    const char *scene;
    struct oracle_settings settings;
    const char *file, *hits, *places, *compare;
    bool tiles, json;
};

enum option_outcome oracle_options_parse(int argc, char **argv, struct oracle_options *options);

#endif /* TESTS_ORACLE_OPTIONS_H */
