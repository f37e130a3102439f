#include "options.h"
#include "viewer.h"

#include "../common/output_file.h"
#include "../common/text.h"

#include <stdlib.h>

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

int main(int argc, char **argv)
{
    struct view_options options;
    output_set_speaker("sluice-view: ");
    switch (options_read(argc, argv, &options)) {
    case OPTIONS_HELP: return text_exit_status(EXIT_SUCCESS);
    case OPTIONS_ERROR: return EXIT_USAGE;
    case OPTIONS_RUN: break;
    }
    if (options.list_devices)
        return text_exit_status(gpu_list_devices() > 0 ? EXIT_SUCCESS : EXIT_NO_DEVICE);
    return viewer_run(&options);
}
