/** Writes the HTML report of a walk. */
#ifndef SAMPLES_STREAMING_GALLERY_REPORT_H
#define SAMPLES_STREAMING_GALLERY_REPORT_H

#include "measure.h"

struct gallery_report_info {
    const char *folder; ///< folder of report.html and the pictures
    const char *command_line;
    const char *device_name;
    const struct picture_list *pictures;
    const uint32_t *written_frames; ///< frames whose pictures are written
    uint32_t written_count;
    bool compared; ///< true: pictures of the truth are written, too
};

/** Writes "folder/frame-0012.png"; `kind` is "frame", "truth" or "flip". */
void gallery_report_picture_path(const char *folder, const char *kind, uint32_t frame, char *path,
                                 size_t size);

/** Reports errors on stderr. */
bool gallery_report_write(const struct gallery_report_info *info, const struct measure *measure);

#endif /* SAMPLES_STREAMING_GALLERY_REPORT_H */
