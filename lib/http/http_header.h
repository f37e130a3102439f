/** The lines of an answer's header that matter. */
#ifndef SLC_HTTP_HTTP_HEADER_H
#define SLC_HTTP_HTTP_HEADER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct slc_http_header {
    uint32_t status;
    bool has_range;
    bool is_encoded;              ///< compressed in transit
    uint64_t first, last;         ///< of Content-Range
    uint64_t total_size;          ///< of Content-Range; UINT64_MAX: not told
    uint64_t length;              ///< Content-Length; UINT64_MAX: not told
    char etag[256], modified[64]; ///< empty: not told, or too long
    char date[64];                ///< when the answer was made; as above
};

void slc_http_header_begin(struct slc_http_header *header);
/** Takes a line, which need not end with a 0. A status line begins a new header. */
void slc_http_header_line(struct slc_http_header *header, const char *line, size_t size);

#endif /* SLC_HTTP_HTTP_HEADER_H */
