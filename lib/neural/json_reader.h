/**
 * Reads JSON front to back without a tree: no memory, no recursion, time linear in the text. Strict
 * as RFC 8259 has it, apart from invalid UTF-8, which strings keep. Decision 86 says why.
 *
 * The first error stays: every later call returns false.
 */
#ifndef SLC_NEURAL_JSON_READER_H
#define SLC_NEURAL_JSON_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Values in values. A deeper text is refused. */
#define SLC_JSON_MAX_DEPTH 32u

struct slc_json {
    char *text; ///< borrowed, changed: strings are decoded in place; text[size] is 0
    size_t size;
    char *at;
    uint32_t depth;
    bool is_first;       ///< the next element of the innermost array or object is its first
    const char *trouble; ///< NULL, or the first error
};

void slc_json_begin(struct slc_json *json, char *text, size_t size);

/** Notes an error unless there is one. Returns false. */
bool slc_json_fail(struct slc_json *json, const char *trouble);

/** Enters an array or object; then call the next_ function until it returns false. */
bool slc_json_enter_array(struct slc_json *json);
bool slc_json_enter_object(struct slc_json *json);

/** Goes to the next value. False behind the last one, or on an error. */
bool slc_json_next_element(struct slc_json *json);
/** `*key` lives as long as the text. */
bool slc_json_next_member(struct slc_json *json, const char **key);

/** Values. A value of another kind is an error. A string with a NUL in it is one, too. */
bool slc_json_read_string(struct slc_json *json, const char **string);
bool slc_json_read_number(struct slc_json *json, double *number);
bool slc_json_read_u64(struct slc_json *json, uint64_t *number); ///< at most 2^53
bool slc_json_read_u32(struct slc_json *json, uint32_t *number);
bool slc_json_skip(struct slc_json *json);

/** Checks that nothing but blanks follows. */
bool slc_json_end(struct slc_json *json);

#endif /* SLC_NEURAL_JSON_READER_H */
