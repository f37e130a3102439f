/** Header of an answer: the fields that Sluice uses. */
#ifndef SLC_HTTP_HTTP_HEADER_H
#define SLC_HTTP_HTTP_HEADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct slc_http_header {
    uint32_t status;
    bool has_range;
    bool is_encoded;              ///< compressed in transit
    uint64_t first, last;         ///< byte range of Content-Range
    uint64_t total_size;          ///< total of Content-Range; UINT64_MAX: missing
    uint64_t length;              ///< Content-Length; UINT64_MAX: missing
    char etag[256], modified[64]; ///< empty: missing or too long
    char date[64];                ///< date of the answer; empty: missing or too long
};

void slc_http_header_begin(struct slc_http_header *header);
/** Parses a line, not necessarily 0-terminated. A status line begins a new header. */
void slc_http_header_line(struct slc_http_header *header, const char *line, size_t size);

#endif /* SLC_HTTP_HTTP_HEADER_H */
