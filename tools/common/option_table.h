/** Command lines: a table of options becomes the parser and the --help text. */
#ifndef TOOLS_COMMON_OPTION_TABLE_H
#define TOOLS_COMMON_OPTION_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum option_kind {
    OPTION_SECTION, ///< a heading in the help text; `help` is its words
    OPTION_FLAG,    ///< bool: true
    OPTION_UINT,    ///< uint32_t within [minimum, maximum]
    OPTION_REAL,    ///< double within [minimum, maximum]; "1/16" is a number too;
                    ///< a default of NaN is none
    OPTION_TEXT,    ///< const char *, borrowed from argv
    OPTION_CHOICE,  ///< int: index in `choices`, which are separated by '|'
    OPTION_SIZE,    ///< uint32_t[2]: WxH, both within [minimum, maximum]
    OPTION_LIST,    ///< struct option_list: this argument and those after it that are no options;
                    ///< after "--" all that follow
};

struct option_list {
    char *const *items; ///< borrowed from argv
    size_t count;
};

struct option {
    enum option_kind kind;
    const char *name;    ///< without the dashes
    const char *operand; ///< shown in the help text; for choices: the choices
    void *value;         ///< holds the default before parsing
    const char *help;    ///< may hold newlines; the default is appended
    double minimum, maximum;
};

enum option_outcome { OPTIONS_RUN, OPTIONS_HELP, OPTIONS_ERROR };

/** Fills the values; prints the help text for --help, or what is wrong on stderr. */
enum option_outcome options_parse(const struct option *options, size_t option_count,
                                  const char *usage, int argc, char *const *argv);

#endif /* TOOLS_COMMON_OPTION_TABLE_H */
