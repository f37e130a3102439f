#include "text.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define NO_CHARACTER UINT32_MAX

/* The next character and how many bytes it has: NO_CHARACTER and 1 where there is none. As
 * Unicode's table 3-7 has it: neither longer than need be, nor a surrogate. */
static uint32_t next_character(const unsigned char *text, size_t *size)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t length = text[0] < 0x80           ? 1
                    : (text[0] >> 5) == 0x06 ? 2
                    : (text[0] >> 4) == 0x0E ? 3
                    : (text[0] >> 3) == 0x1E ? 4
                                             : 0;
    uint32_t character = length > 1 ? text[0] & (0x7Fu >> length) : text[0];
    *size = 1;
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xC0) != 0x80) /* also at the end */
            return NO_CHARACTER;
        character = character << 6 | (text[i] & 0x3Fu);
    }
    if (length == 0 || character < least[length] || character > 0x10FFFF ||
        (character >= 0xD800 && character < 0xE000))
        return NO_CHARACTER;
    *size = length;
    return character;
}

/* Tests for controls, separators of lines, and controls of the writing direction. */
static bool is_active(uint32_t c)
{
    return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x061C || c == 0x200E || c == 0x200F ||
           (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

void text_write(FILE *out, const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    for (size_t size; *at; at += size) {
        uint32_t c = next_character(at, &size);
        if (c == '\n' || c == '\t')
            fputs(c == '\n' ? "\\n" : "\\t", out);
        else if (c == NO_CHARACTER || (is_active(c) && c < 0x80))
            fprintf(out, "\\x%02x", *at);
        else if (is_active(c))
            fprintf(out, "\\u%04x", (unsigned)c);
        else
            fwrite(at, 1, size, out);
    }
}

/* Listener of the program's messages. There is only one, like stderr. */
static struct {
    void (*listen)(void *user_data, const char *line);
    void *user_data;
} listener;

void text_set_listener(void (*listen)(void *user_data, const char *line), void *user_data)
{
    listener.listen = listen;
    listener.user_data = user_data;
}

void text_say(const char *format, ...)
{
    char line[8192];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    text_write(stderr, line);
    fputc('\n', stderr);
    if (listener.listen)
        listener.listen(listener.user_data, line);
}

bool text_flush(const char *speaker)
{
    bool failed = ferror(stdout) != 0;
    errno = 0;
    if (fflush(stdout) == 0 && !failed)
        return true;
    text_say("%scannot write the answer%s%s", speaker, errno ? ": " : "",
             errno ? strerror(errno) : "");
    return false;
}

int text_exit_status(int status)
{
    return text_flush("") || status != EXIT_SUCCESS ? status : EXIT_FAILURE;
}

void text_write_json(FILE *out, const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    fputc('"', out);
    for (size_t size; *at; at += size) {
        uint32_t c = next_character(at, &size);
        if (c == '"' || c == '\\')
            fprintf(out, "\\%c", (int)c);
        else if (c == NO_CHARACTER || is_active(c) || c == '<')
            fprintf(out, "\\u%04x", c == NO_CHARACTER ? 0xFFFDu : (unsigned)c);
        else
            fwrite(at, 1, size, out);
    }
    fputc('"', out);
}
