/**
 * JSON reader: front to back, without tree, allocation or recursion, in linear time. Strict by
 * RFC 8259, except that strings keep invalid UTF-8 (decision 86).
 *
 * After the first error, every call returns false.
 */
#ifndef SLC_NEURAL_JSON_READER_H
#define SLC_NEURAL_JSON_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Most levels of nested values. Deeper text is an error. */
#define SLC_JSON_MAX_DEPTH 32u

struct slc_json {
    char *text; ///< borrowed, changed: strings are decoded in place; text[size] is 0
    size_t size;
    char *at;
    uint32_t depth;
    bool is_first;       ///< the innermost array or object has no element yet
    const char *trouble; ///< NULL, or the first error
};

void slc_json_begin(struct slc_json *json, char *text, size_t size);

/** Sets the error, unless there was one. Returns false. */
bool slc_json_fail(struct slc_json *json, const char *trouble);

/** Enters an array or object. Then call the next_ function until false. */
bool slc_json_enter_array(struct slc_json *json);
bool slc_json_enter_object(struct slc_json *json);

/** Goes to the next value. False: no more values, or an error. */
bool slc_json_next_element(struct slc_json *json);
/** Goes to the next member. `*key` lives as long as the text. */
bool slc_json_next_member(struct slc_json *json, const char **key);

/** Reads a value. Errors: a value of another kind; a string with NUL. */
bool slc_json_read_string(struct slc_json *json, const char **string);
bool slc_json_read_number(struct slc_json *json, double *number);
bool slc_json_read_u64(struct slc_json *json, uint64_t *number); ///< at most 2^53
bool slc_json_read_u32(struct slc_json *json, uint32_t *number);
bool slc_json_skip(struct slc_json *json);

/** Checks that only blanks follow. */
bool slc_json_end(struct slc_json *json);

#endif /* SLC_NEURAL_JSON_READER_H */
