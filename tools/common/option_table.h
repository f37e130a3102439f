/**
 * Command lines of all programs: a table of options becomes the parser and the --help text. See
 * docs/decisions/0050-one-option-table.md.
 */
#ifndef TOOLS_COMMON_OPTION_TABLE_H
#define TOOLS_COMMON_OPTION_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum option_kind {
    OPTION_SECTION,      ///< Heading in the help text. `help` has its words.
    OPTION_FLAG,         ///< bool. Becomes true.
    OPTION_UINT,         ///< uint32_t.
    OPTION_INT,          ///< int32_t.
    OPTION_REAL,         ///< double. "1/16" is a number, too.
    OPTION_SECONDS,      ///< double, in seconds. Takes "250ms", "1.5" (seconds), also us, s, min.
    OPTION_MILLISECONDS, ///< double, in milliseconds. As above, "1.5" is in milliseconds.
    OPTION_BYTES,        ///< uint64_t, in bytes. Takes "512K", "2G", also M, T; "64" is in MiB.
    OPTION_TEXT,         ///< const char *, borrowed from argv.
    OPTION_CHOICE,       ///< int. Index in `operand`, whose words are separated by '|'.
    OPTION_EXTENT,       ///< uint32_t[2]. "WxH", both within the range.
    OPTION_CUSTOM,       ///< Read by `parse`.
    OPTION_REPEATED,     ///< struct option_texts. A text for each time that the option is given.
    OPTION_LIST,         ///< struct option_list. All arguments up to the next option that begins
                         ///< with "--"; after "--" all that follow.
    OPTION_WORD,         ///< const char *. A word that is no option. Rows are filled in order.
    OPTION_WORDS,        ///< struct option_list. All further words that are no options.
    OPTION_REST,         ///< struct option_list. All arguments behind "--".
    OPTION_RENAMED,      ///< Refused; `operand` is the name that the option has now.
};

/** Arguments that stand one after the other in argv. */
struct option_list {
    char *const *items; ///< borrowed from argv
    size_t count;
};

#define OPTION_MOST_REPEATS 64

struct option_texts {
    const char *items[OPTION_MOST_REPEATS]; ///< borrowed from argv
    size_t count;
};

/** A row of the table. An option that is given twice has its last value. */
struct option {
    enum option_kind kind;
    const char *name; ///< Without dashes. Words: NULL.
    /** Stands for the value in the help text. Choices: the words to choose from. */
    const char *operand;
    /**
     * Default, written as a user would write it. It is parsed into `value` first. In parentheses:
     * words for the help text alone, `value` is left as it is. NULL for flags and words.
     */
    const char *initial;
    void *value;
    /** Wrapped at the end of the line. Words: what is missing without them ("a trace"). */
    const char *help;
    double minimum, maximum; ///< WORD and WORDS: a minimum of 1 makes them required.
    char letter;             ///< 'o' for -o; 0: none.
    bool (*parse)(const char *text, void *value); ///< CUSTOM: false if the text is no such value.
    const char *wanted; ///< CUSTOM: the values, behind "wants". NULL: `operand`.
    bool *given;        ///< becomes true if the command line has the option; may be NULL
};

struct option_table {
    const char *program; ///< Stands in front of messages: "sluice-bake".
    const char *usage;   ///< First part of the help text.
    const char *notes;   ///< Last part of the help text. NULL: none.
    const struct option *options;
    size_t option_count;
};

enum option_outcome { OPTIONS_RUN, OPTIONS_HELP, OPTIONS_ERROR };

/**
 * Fills the values. Prints the help text for --help and -h. Says on stderr what is wrong.
 *
 * Words may stand between options. The words of OPTION_WORDS are moved to the front of argv, so a
 * table has OPTION_WORDS or OPTION_LIST. A program that needs no word must not have OPTION_WORDS
 * with a minimum.
 */
enum option_outcome options_parse(const struct option_table *table, int argc, char **argv);

/** Reports an error on stderr, after the program's name. Returns false. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
bool
options_refuse(const struct option_table *table, const char *format, ...);

#endif /* TOOLS_COMMON_OPTION_TABLE_H */
