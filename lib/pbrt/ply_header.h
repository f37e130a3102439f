/** Header of a PLY file, checked against the file's size. */
#ifndef SLC_PBRT_PLY_HEADER_H
#define SLC_PBRT_PLY_HEADER_H

#include "pbrt/byte_window.h"

#define SLC_PBRT_PLY_MAX_ELEMENTS 16u
#define SLC_PBRT_PLY_MAX_PROPERTIES 64u

enum slc_pbrt_ply_format { SLC_PBRT_PLY_ASCII, SLC_PBRT_PLY_LITTLE, SLC_PBRT_PLY_BIG };

enum slc_pbrt_ply_type {
    SLC_PBRT_PLY_INT8,
    SLC_PBRT_PLY_UINT8,
    SLC_PBRT_PLY_INT16,
    SLC_PBRT_PLY_UINT16,
    SLC_PBRT_PLY_INT32,
    SLC_PBRT_PLY_UINT32,
    SLC_PBRT_PLY_FLOAT,
    SLC_PBRT_PLY_DOUBLE,
    SLC_PBRT_PLY_NO_TYPE
};

enum slc_pbrt_ply_role {
    SLC_PBRT_PLY_X,
    SLC_PBRT_PLY_Y,
    SLC_PBRT_PLY_Z,
    SLC_PBRT_PLY_NX,
    SLC_PBRT_PLY_NY,
    SLC_PBRT_PLY_NZ,
    SLC_PBRT_PLY_U,
    SLC_PBRT_PLY_V,
    SLC_PBRT_PLY_INDICES,
    SLC_PBRT_PLY_NO_ROLE
};

struct slc_pbrt_ply_property {
    enum slc_pbrt_ply_type type;
    enum slc_pbrt_ply_type count_type; ///< type of a list's count; NO_TYPE: not a list
    enum slc_pbrt_ply_role role;
};

struct slc_pbrt_ply_element {
    uint64_t count;
    uint32_t property_count;
    uint32_t stride; ///< bytes in binary files; 0: has lists
    bool is_vertex, is_face;
    struct slc_pbrt_ply_property properties[SLC_PBRT_PLY_MAX_PROPERTIES];
};

struct slc_pbrt_ply_header {
    enum slc_pbrt_ply_format format;
    uint32_t element_count;
    uint32_t vertex_element, face_element;
    uint32_t roles; ///< bits of roles of vertex properties
    struct slc_pbrt_ply_element elements[SLC_PBRT_PLY_MAX_ELEMENTS];
};

/** Returns the bytes of a number in binary files. */
uint32_t slc_pbrt_ply_size(enum slc_pbrt_ply_type type);

/** Reads the header and goes to its end. Returns NULL, or the error's description. */
const char *slc_pbrt_ply_read_header(struct slc_pbrt_window *window,
                                     struct slc_pbrt_ply_header *header);

#endif /* SLC_PBRT_PLY_HEADER_H */
