/**
 * Warnings of libvips with the name of the picture. They come through GLib's log, which knows no
 * picture: the thread that calls libvips tells which one it is.
 */
#ifndef SLC_BAKE_VIPS_WARNINGS_H
#define SLC_BAKE_VIPS_WARNINGS_H

#include "base/said.h"

/** A picture that libvips reads. Set `path` and `log`; zero the rest. */
struct slc_vips_warnings {
    const char *path;             ///< borrowed
    const SluiceLogCallback *log; ///< borrowed; NULL: none
    struct slc_said said;
    bool was_buffered; ///< text of libvips's error buffer was logged
    struct slc_vips_warnings *outer;
};

/** From the first baker to the end of the last one, warnings of libvips come here. Any thread. */
void slc_vips_warnings_listen(void);
void slc_vips_warnings_end(void);

/** Between these two, warnings on this thread are of this picture. Calls may be nested. */
void slc_vips_warnings_enter(struct slc_vips_warnings *warnings);
void slc_vips_warnings_leave(struct slc_vips_warnings *warnings);

#endif /* SLC_BAKE_VIPS_WARNINGS_H */
