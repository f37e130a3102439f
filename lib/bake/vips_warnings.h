/**
 * Warnings of libvips with the name of the picture. GLib's log delivers warnings without a picture;
 * the calling thread's entry names the picture.
 */
#ifndef SLC_BAKE_VIPS_WARNINGS_H
#define SLC_BAKE_VIPS_WARNINGS_H

#include "base/said.h"

/** A picture that libvips reads. Set `path` and `log`; zero the rest. */
struct slc_vips_warnings {
    const char *path;             ///< borrowed
    const SluiceLogCallback *log; ///< borrowed; NULL: none
    struct slc_said said;
    bool was_buffered; ///< text from libvips's error buffer was logged
    struct slc_vips_warnings *outer;
};

/** Receives warnings of libvips from the first baker's start to the last one's end. Any thread. */
void slc_vips_warnings_listen(void);
void slc_vips_warnings_end(void);

/** Attributes this thread's warnings to this picture until the leave call. Calls may be nested. */
void slc_vips_warnings_enter(struct slc_vips_warnings *warnings);
void slc_vips_warnings_leave(struct slc_vips_warnings *warnings);

#endif /* SLC_BAKE_VIPS_WARNINGS_H */
