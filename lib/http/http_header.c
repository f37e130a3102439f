#include "http/http_header.h"

#include <string.h>

void slc_http_header_begin(struct slc_http_header *header)
{
    *header = (struct slc_http_header){.total_size = UINT64_MAX, .length = UINT64_MAX};
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Gets a line's value, trimmed, if the line has this name. `name` is in lower case. */
static bool get_value(const char *line, size_t size, const char *name, const char **value,
                      size_t *value_size)
{
    size_t length = strlen(name);
    if (size <= length || line[length] != ':')
        return false;
    for (size_t i = 0; i < length; i++)
        if (lower(line[i]) != name[i])
            return false;
    const char *first = line + length + 1, *end = line + size;
    while (first < end && (*first == ' ' || *first == '\t'))
        first++;
    while (end > first && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r' || end[-1] == '\n'))
        end--;
    *value = first;
    *value_size = (size_t)(end - first);
    return true;
}

/* Reads digits up to `end` and moves *at behind them. False: no digit, or above 2^63 - 1. */
static bool read_number(const char **at, const char *end, uint64_t *number)
{
    const char *first = *at;
    uint64_t value = 0;
    for (; *at < end && **at >= '0' && **at <= '9'; (*at)++) {
        if (value > (INT64_MAX - 9) / 10)
            return false;
        value = value * 10 + (uint64_t)(**at - '0');
    }
    *number = value;
    return *at > first;
}

static bool skip(const char **at, const char *end, char c)
{
    if (*at == end || **at != c)
        return false;
    (*at)++;
    return true;
}

/* Reads "bytes FIRST-LAST/TOTAL". TOTAL may be "*". */
static void read_range(struct slc_http_header *header, const char *at, size_t size)
{
    const char *end = at + size;
    uint64_t first, last, total = UINT64_MAX;
    header->has_range = false;
    if (size < 6 || memcmp(at, "bytes ", 6) != 0)
        return;
    at += 6;
    if (!read_number(&at, end, &first) || !skip(&at, end, '-') || !read_number(&at, end, &last) ||
        !skip(&at, end, '/'))
        return;
    if (!skip(&at, end, '*') && !read_number(&at, end, &total))
        return;
    if (at != end || first > last || last >= total)
        return;
    header->first = first;
    header->last = last;
    header->total_size = total;
    header->has_range = true;
}

static void copy_value(char *to, size_t room, const char *value, size_t size)
{
    to[0] = '\0';
    for (size_t i = 0; i < size; i++)
        if ((unsigned char)value[i] < ' ' ||
            value[i] == 0x7f) /* the value is sent back to the server */
            return;
    if (size >= room)
        return;
    memcpy(to, value, size);
    to[size] = '\0';
}

static void read_status(struct slc_http_header *header, const char *line, size_t size)
{
    const char *end = line + size, *at = memchr(line, ' ', size);
    uint64_t status = 0;
    slc_http_header_begin(header);
    if (at) {
        at++;
        if (read_number(&at, end, &status) && status < 1000)
            header->status = (uint32_t)status;
    }
}

void slc_http_header_line(struct slc_http_header *header, const char *line, size_t size)
{
    const char *value;
    size_t length;
    if (size >= 5 && memcmp(line, "HTTP/", 5) == 0) {
        read_status(header, line, size);
    } else if (get_value(line, size, "content-range", &value, &length)) {
        read_range(header, value, length);
    } else if (get_value(line, size, "content-length", &value, &length)) {
        if (!read_number(&value, value + length, &header->length))
            header->length = UINT64_MAX;
    } else if (get_value(line, size, "content-encoding", &value, &length)) {
        header->is_encoded = length > 0 && !(length == 8 && memcmp(value, "identity", 8) == 0);
    } else if (get_value(line, size, "etag", &value, &length)) {
        copy_value(header->etag, sizeof header->etag, value, length);
    } else if (get_value(line, size, "last-modified", &value, &length)) {
        copy_value(header->modified, sizeof header->modified, value, length);
    } else if (get_value(line, size, "date", &value, &length)) {
        copy_value(header->date, sizeof header->date, value, length);
    }
}
