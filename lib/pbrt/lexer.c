#include "pbrt/lexer.h"

#include <string.h>

enum byte_class {
    PART_OF_WORD,
    BLANK,
    NEW_LINE,
    MARK, ///< [ ] and "
    STOP  ///< 0: possibly the end of the window
};

static const unsigned char CLASSES[256] = {
    [0] = STOP,        [' '] = BLANK, ['\t'] = BLANK, ['\r'] = BLANK,
    ['\n'] = NEW_LINE, ['['] = MARK,  [']'] = MARK,   ['"'] = MARK,
};

SluiceResult slc_pbrt_lexer_open(struct slc_pbrt_lexer *lexer, const char *path,
                                 struct slc_pbrt_watch *watch, const SluiceAllocationCallbacks *cb)
{
    *lexer = (struct slc_pbrt_lexer){.line = 1};
    SluiceResult result = slc_pbrt_window_open_watched(&lexer->window, path, watch, cb);
    /* A byte order mark of UTF-8 says nothing. */
    struct slc_pbrt_window *window = &lexer->window;
    if (result == SLUICE_SUCCESS && window->end >= 3 &&
        memcmp(window->bytes, "\xEF\xBB\xBF", 3) == 0) {
        window->cursor = 3;
        lexer->line_start = 3;
    }
    return result;
}

void slc_pbrt_lexer_finish(struct slc_pbrt_lexer *lexer)
{
    slc_pbrt_window_finish(&lexer->window);
}

/* True if a byte of 0 at the cursor is only the end of the window. Reads more bytes if so. */
static bool read_on(struct slc_pbrt_window *window)
{
    if (window->cursor < window->end || window->is_over)
        return false;
    slc_pbrt_window_refill(window, window->cursor);
    return true;
}

/* Skips a comment up to LF or CR, which the next round skips. */
static void skip_comment(struct slc_pbrt_window *window)
{
    for (;;) {
        unsigned char c = window->bytes[window->cursor];
        if (c == '\n' || c == '\r')
            return;
        if (c == 0 && window->cursor >= window->end) {
            if (!read_on(window))
                return;
            continue;
        }
        window->cursor++;
    }
}

unsigned char slc_pbrt_skip_blanks(struct slc_pbrt_lexer *lexer)
{
    struct slc_pbrt_window *window = &lexer->window;
    for (;;) {
        unsigned char c = window->bytes[window->cursor];
        if (CLASSES[c] == BLANK) {
            window->cursor++;
        } else if (c == '\n') {
            window->cursor++;
            lexer->line++;
            lexer->line_start = slc_pbrt_window_offset(window);
        } else if (c == '#') {
            skip_comment(window);
        } else if (c != 0 || !read_on(window)) {
            return c;
        }
    }
}

/* Reads a word. Keeps its start as an offset, because the window's bytes may move. */
static void read_word(struct slc_pbrt_window *window, struct slc_pbrt_token *token)
{
    size_t start = window->cursor;
    for (;;) {
        while (CLASSES[window->bytes[window->cursor]] == PART_OF_WORD)
            window->cursor++;
        if (window->bytes[window->cursor] != 0)
            break;
        if (window->cursor < window->end) {
            window->cursor++;
        } else if (window->is_over || window->cursor - start > SLC_PBRT_MAX_TOKEN) {
            break;
        } else {
            start -= slc_pbrt_window_refill(window, start);
        }
    }
    token->length = window->cursor - start;
    token->text = (const char *)window->bytes + start;
    token->kind =
        token->length > SLC_PBRT_MAX_TOKEN ? SLC_PBRT_TOKEN_TOO_LONG : SLC_PBRT_TOKEN_WORD;
}

static void read_string(struct slc_pbrt_window *window, struct slc_pbrt_token *token)
{
    size_t start = ++window->cursor;
    token->kind = SLC_PBRT_TOKEN_OPEN_STRING;
    for (;;) {
        unsigned char c = window->bytes[window->cursor];
        if (c == 0 && window->cursor >= window->end) {
            if (window->is_over)
                return;
            if (window->cursor - start > SLC_PBRT_MAX_TOKEN)
                break;
            start -= slc_pbrt_window_refill(window, start);
            continue;
        }
        if (c == '\n')
            return;
        if (c == '"')
            break;
        if (c == '\\') {
            token->has_escape = true;
            if (window->cursor + 1 >= window->end && !window->is_over)
                start -= slc_pbrt_window_refill(window, start);
            if (window->cursor + 1 < window->end && window->bytes[window->cursor + 1] != '\n')
                window->cursor++;
        }
        window->cursor++;
    }
    token->length = window->cursor - start;
    token->text = (const char *)window->bytes + start;
    token->kind =
        token->length > SLC_PBRT_MAX_TOKEN ? SLC_PBRT_TOKEN_TOO_LONG : SLC_PBRT_TOKEN_STRING;
    window->cursor += token->kind == SLC_PBRT_TOKEN_STRING;
}

void slc_pbrt_next_token(struct slc_pbrt_lexer *lexer, struct slc_pbrt_token *token)
{
    struct slc_pbrt_window *window = &lexer->window;
    unsigned char c = slc_pbrt_skip_blanks(lexer);
    *token = (struct slc_pbrt_token){
        .text = "",
        .offset = slc_pbrt_window_offset(window),
        .line = lexer->line,
        .column = (uint32_t)(slc_pbrt_window_offset(window) - lexer->line_start) + 1};
    if (c == 0 && window->cursor >= window->end) {
        token->kind = SLC_PBRT_TOKEN_END;
    } else if (c == '[' || c == ']') {
        token->kind = c == '[' ? SLC_PBRT_TOKEN_OPEN : SLC_PBRT_TOKEN_CLOSE;
        window->cursor++;
    } else if (c == '"') {
        read_string(window, token);
    } else {
        read_word(window, token);
    }
}

size_t slc_pbrt_unescape(const struct slc_pbrt_token *token, char *out)
{
    static const char NAMES[] = "bfnrt", BYTES[] = "\b\f\n\r\t";
    size_t length = 0;
    for (size_t i = 0; i < token->length; i++) {
        char c = token->text[i];
        if (c == '\\' && i + 1 < token->length) {
            c = token->text[++i];
            const char *name = c ? strchr(NAMES, c) : NULL;
            c = name ? BYTES[name - NAMES] : c;
        }
        out[length++] = c;
    }
    return length;
}
