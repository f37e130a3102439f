/* Says what is in files of textures, and what the Vulkan devices of this machine can do for Sluice.
 */
#include "show.h"

#include "../common/text.h"

#include <stdio.h>

static int show_files(const struct options *options)
{
    int status = ALL_SHOWN;
    for (size_t i = 0; i < options->files.count; i++)
        if (show_file(options, options->files.items[i]) != ALL_SHOWN)
            status = NOT_SHOWN;
    return status;
}

int main(int argc, char **argv)
{
    struct options options;
    int status = ALL_SHOWN;
    enum option_outcome outcome = parse_options(&options, argc, argv);
    if (outcome == OPTIONS_ERROR)
        return WRONG_USAGE;
    if (outcome == OPTIONS_HELP)
        status = ALL_SHOWN;
    else if (options.png)
        status = write_picture(&options);
    else if (options.files.count)
        status = show_files(&options);
    else
        status = show_devices(&options);
    return text_flush("sluice-info: ") ? status : NOT_SHOWN;
}
