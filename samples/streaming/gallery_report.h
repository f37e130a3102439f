/** The page that shows how a walk went. */
#ifndef SAMPLES_STREAMING_GALLERY_REPORT_H
#define SAMPLES_STREAMING_GALLERY_REPORT_H

#include "measure.h"

struct gallery_report_info {
    const char *folder; ///< report.html is written here, the pictures are found here
    const char *command_line;
    const char *device_name;
    const struct picture_list *pictures;
    const uint32_t *written_frames; ///< those that have pictures
    uint32_t written_count;
    bool compared; ///< there are pictures of the truth, too
};

/** "folder/frame-0012.png"; `kind` is "frame", "truth" or "flip". */
void gallery_report_picture_path(const char *folder, const char *kind, uint32_t frame, char *path,
                                 size_t size);

/** Says on stderr why it failed. */
bool gallery_report_write(const struct gallery_report_info *info, const struct measure *measure);

#endif /* SAMPLES_STREAMING_GALLERY_REPORT_H */
