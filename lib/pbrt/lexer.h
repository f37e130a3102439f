/** Tokens of a scene file, with their places. */
#ifndef SLC_PBRT_LEXER_H
#define SLC_PBRT_LEXER_H

#include "pbrt/byte_window.h"

/** Longest word or string, in bytes. */
#define SLC_PBRT_MAX_TOKEN ((size_t)1 << 16)

enum slc_pbrt_token_kind {
    SLC_PBRT_TOKEN_END,
    SLC_PBRT_TOKEN_OPEN,  ///< [
    SLC_PBRT_TOKEN_CLOSE, ///< ]
    SLC_PBRT_TOKEN_STRING,
    SLC_PBRT_TOKEN_WORD, ///< also numbers
    SLC_PBRT_TOKEN_OPEN_STRING,
    SLC_PBRT_TOKEN_TOO_LONG,
    SLC_PBRT_TOKEN_FILE_END, ///< end of an imported file; not from the lexer
};

struct slc_pbrt_token {
    enum slc_pbrt_token_kind kind;
    bool has_escape;  ///< a string with backslashes
    const char *text; ///< without quotes; valid until the next token; a byte follows it
    size_t length;    ///< in bytes
    uint64_t offset;  ///< offset of the first byte in the text
    uint32_t file;    ///< set by the parser
    uint32_t line, column;
};

struct slc_pbrt_lexer {
    struct slc_pbrt_window window;
    uint32_t line;
    uint64_t line_start; ///< offset of the line's first byte
};

/** Opens a file. `watch` may be NULL. Errors: slc_pbrt_window_open_watched's. */
SluiceResult slc_pbrt_lexer_open(struct slc_pbrt_lexer *lexer, const char *path,
                                 struct slc_pbrt_watch *watch, const SluiceAllocationCallbacks *cb);
void slc_pbrt_lexer_finish(struct slc_pbrt_lexer *lexer);

void slc_pbrt_next_token(struct slc_pbrt_lexer *lexer, struct slc_pbrt_token *token);

/** Replaces escapes; `out` has room for the token's length. Returns the length. */
size_t slc_pbrt_unescape(const struct slc_pbrt_token *token, char *out);

/** Skips blanks and comments. Returns the first byte of the next token, or 0 at the end. */
unsigned char slc_pbrt_skip_blanks(struct slc_pbrt_lexer *lexer);

#endif /* SLC_PBRT_LEXER_H */
